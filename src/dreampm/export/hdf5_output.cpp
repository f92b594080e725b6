#include "dreampm/export/hdf5_output.h"

#include <fcntl.h>
#include <unistd.h>
#if __has_include(<H5FDdevelop.h>)
#include <H5FDdevelop.h>
#endif

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "dreampm/base/error.h"

namespace dreampm::exchange {
namespace {

/// What HDF5 hands from H5Pset_driver to `open`: where errors go.
struct Settings {
  int* error;
};

/// The file, as HDF5 sees it.
struct Output : H5FD_t {
  int file = -1;
  haddr_t allocated = 0, end = 0;
  int* error = nullptr;
};
Output* mine(H5FD_t* file) { return static_cast<Output*>(file); }
const Output* mine(const H5FD_t* file) { return static_cast<const Output*>(file); }

H5FD_t* open_output(const char* name, unsigned, hid_t access, haddr_t) {
  const auto* settings = static_cast<const Settings*>(H5Pget_driver_info(access));
  const int file = ::open(name, O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file < 0) return *settings->error = errno, nullptr;
  auto* const output = new Output{};
  output->file = file;
  output->error = settings->error;
  return output;
}
herr_t close_output(H5FD_t* file) {
  if (::close(mine(file)->file) != 0 && *mine(file)->error == 0) *mine(file)->error = errno;
  delete mine(file);
  return 0;
}
haddr_t allocated(const H5FD_t* file, H5FD_mem_t) { return mine(file)->allocated; }
herr_t set_allocated(H5FD_t* file, H5FD_mem_t, haddr_t place) { return mine(file)->allocated = place, 0; }
haddr_t end_of(const H5FD_t* file, H5FD_mem_t) { return mine(file)->end; }

/// What was never written is zero.
herr_t read_output(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t at, std::size_t size, void* to) {
  auto* p = static_cast<char*>(to);
  while (size > 0) {
    const ssize_t n = ::pread(mine(file)->file, p, size, static_cast<off_t>(at));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    p += n, at += static_cast<haddr_t>(n), size -= static_cast<std::size_t>(n);
  }
  std::memset(p, 0, size);
  return 0;
}
herr_t write_output(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t at, std::size_t size, const void* from) {
  Output& output = *mine(file);
  output.end = std::max(output.end, at + size);
  const auto* p = static_cast<const char*>(from);
  while (size > 0 && *output.error == 0) {
    const ssize_t n = ::pwrite(output.file, p, size, static_cast<off_t>(at));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) {
      *output.error = n < 0 ? errno : ENOSPC;
      break;
    }
    p += n, at += static_cast<haddr_t>(n), size -= static_cast<std::size_t>(n);
  }
  return 0;
}
herr_t truncate_output(H5FD_t* file, hid_t, hbool_t) {
  Output& output = *mine(file);
  if (output.end == output.allocated) return 0;
  if (*output.error == 0 && ::ftruncate(output.file, static_cast<off_t>(output.allocated)) != 0) *output.error = errno;
  output.end = output.allocated;
  return 0;
}

const H5FD_class_t& driver() {
  static const H5FD_class_t driver = [] {
    H5FD_class_t d{};
#ifdef H5FD_CLASS_VERSION
    d.version = H5FD_CLASS_VERSION;
    d.value = static_cast<H5FD_class_value_t>(600);  // of those that are left to programs
#endif
    d.name = "dreampm output";
    d.maxaddr = (haddr_t(1) << 62) - 1;
    d.fc_degree = H5F_CLOSE_WEAK;
    d.fapl_size = sizeof(Settings);
    d.open = open_output, d.close = close_output;
    d.get_eoa = allocated, d.set_eoa = set_allocated, d.get_eof = end_of;
    d.read = read_output, d.write = write_output, d.truncate = truncate_output;
    std::fill(std::begin(d.fl_map), std::end(d.fl_map), H5FD_MEM_DEFAULT);
    return d;
  }();
  return driver;
}

hid_t create(const std::filesystem::path& path, hid_t driver_id, int* error) {
  const H5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  const Settings settings{error};
  if (!access.ok() || H5Pset_driver(access, driver_id, &settings) < 0) return -1;
  return H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access);
}

}  // namespace

Hdf5Output::Hdf5Output(const std::filesystem::path& path, const std::filesystem::path& target)
    : target_(target.string()),
      driver_(H5FDregister(&driver()), H5FDunregister),
      file_(create(path, driver_, &error_), H5Fclose) {
  if (!file_.ok()) fail();
}

void Hdf5Output::check() const {
  if (error_ != 0) fail();
}

void Hdf5Output::fail() const {
  fail_run("{}: cannot be written: {}", target_, error_ != 0 ? std::generic_category().message(error_) : h5_reason());
}

}  // namespace dreampm::exchange
