#include <algorithm>
#include <bit>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/io/archive_hdf5.h"
#include "dreampm/io/archive_seal.h"

namespace dreampm {
namespace fs = std::filesystem;
namespace {

static_assert(std::endian::native == std::endian::little, "values go to the file as they lie in memory");

// HDF5 calls this from the outermost message to the innermost.
herr_t take_reason(unsigned, const H5E_error2_t* error, void* out) {
  if (error->desc) *static_cast<std::string*>(out) = error->desc;
  return 0;
}

}  // namespace

H5Handle h5_text_type(std::size_t size) {
  H5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, std::max<std::size_t>(size, 1));
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return type;
}

std::string h5_reason() {
  std::string text;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, take_reason, &text);
  constexpr std::string_view key = "error message = '";
  const std::size_t at = text.find(key);
  if (at == std::string::npos) return text.empty() ? "no reason given" : text;
  const std::size_t begin = at + key.size();
  return text.substr(begin, text.find('\'', begin) - begin);
}

struct ArchiveWriter::Impl {
  std::string name;
  H5Handle file;

  Impl(const fs::path& temporary, const fs::path& target) : name(target.string()), file(create(temporary), H5Fclose) {}

  hid_t create(const fs::path& path) const {
    const H5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    // Built in memory and written by us: when the disk is full, HDF5 1.10 cannot close a file and
    // crashes at exit.
    H5Pset_fapl_core(access, std::size_t(16) << 20, false);
    H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
    const hid_t id = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access);
    if (id < 0) fail();  // before the next call of HDF5 forgets the reason
    return id;
  }

  [[noreturn]] void fail() const { fail_run("{}: cannot be written: {}", name, h5_reason()); }
  void check(bool ok) const {
    if (!ok) fail();
  }

  void attribute(hid_t object, const char* key, hid_t type, const void* data) const {
    const H5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const H5Handle a(H5Acreate2(object, key, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    check(a.ok() && H5Awrite(a, type, data) >= 0);
  }
  void attribute(hid_t object, const char* key, const std::string& text) const {
    const H5Handle type = h5_text_type(text.size());
    attribute(object, key, type, text.c_str());
  }

  void dataset(const std::string& key, hid_t type, const H5Handle& space, const void* data, std::size_t bytes) const {
    if (key.empty() || key.front() == '/' || key.back() == '/')
      fail_input("{}: \"{}\" cannot name an array", name, key);
    const H5Handle link(H5Pcreate(H5P_LINK_CREATE), H5Pclose), create(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_create_intermediate_group(link, 1);
    H5Pset_obj_track_times(create, false);  // equal contents give equal files
    H5Pset_fill_time(create, H5D_FILL_TIME_NEVER);
    const H5Handle set(H5Dcreate2(file, key.c_str(), type, space, link, create, H5P_DEFAULT), H5Dclose);
    if (!set.ok()) {
      const std::string reason = h5_reason();
      if (H5Lexists(file, key.c_str(), H5P_DEFAULT) > 0) fail_input("{}: {} is added twice", name, key);
      fail_run("{}: {} cannot be written: {}", name, key, reason);
    }
    if (bytes > 0) check(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0);
  }
};

template <ArchiveValue T>
void ArchiveWriter::add(const std::string& name, std::span<const T> values) {
  const QuietHdf5 quiet;
  const hsize_t count = values.size();
  const H5Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose);
  impl_.dataset(name, h5_type<T>(), space, values.data(), values.size_bytes());
}

void ArchiveWriter::add(const std::string& name, const std::string& text) {
  const QuietHdf5 quiet;
  const H5Handle type = h5_text_type(text.size());
  const H5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const std::string padded = text.empty() ? std::string(1, '\0') : text;
  impl_.dataset(name, type, space, padded.data(), padded.size());
}

template void ArchiveWriter::add(const std::string&, std::span<const float>);
template void ArchiveWriter::add(const std::string&, std::span<const double>);
template void ArchiveWriter::add(const std::string&, std::span<const std::int32_t>);
template void ArchiveWriter::add(const std::string&, std::span<const std::uint32_t>);
template void ArchiveWriter::add(const std::string&, std::span<const std::uint64_t>);
template void ArchiveWriter::add(const std::string&, std::span<const std::int64_t>);
template void ArchiveWriter::add(const std::string&, std::span<const std::uint8_t>);

void write_archive(const fs::path& file, const ArchiveIdentity& identity,
                   const std::function<void(ArchiveWriter&)>& fill) {
  replace_file(file, [&](const fs::path& temporary) {
    const QuietHdf5 quiet;
    ArchiveWriter::Impl impl(temporary, file);
    impl.attribute(impl.file, archive_key::format, identity.format);
    impl.attribute(impl.file, archive_key::version, H5T_STD_U32LE, &identity.version);
    impl.attribute(impl.file, archive_key::scene_hash, identity.scene_hash);
    ArchiveWriter writer(impl);
    fill(writer);
    impl.check(H5Fflush(impl.file, H5F_SCOPE_GLOBAL) >= 0);
    const ssize_t size = H5Fget_file_image(impl.file, nullptr, 0);
    impl.check(size > 0);
    std::vector<char> image(static_cast<std::size_t>(size));
    impl.check(H5Fget_file_image(impl.file, image.data(), image.size()) == size);
    impl.check(H5Fclose(impl.file.release()) >= 0);
    write_bytes(temporary, image.data(), image.size());
    seal_archive(temporary, impl.name);
  });
}

}  // namespace dreampm
