#include "dreampm/base/file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <sstream>
#include <system_error>

#include "dreampm/base/error.h"

namespace dreampm {
namespace fs = std::filesystem;

void make_folder(const fs::path& folder) {
  std::error_code ec;
  fs::create_directories(folder, ec);
  if (ec || !fs::is_directory(folder))
    fail_input("{}: cannot make this folder: {}", folder.string(),
               ec ? ec.message() : "a file of that name is in the way");
}

namespace {
fs::path temporary_of(fs::path target) { return target += ".part"; }
}  // namespace

void check_replaceable(const fs::path& target) {
  const fs::path folder = target.parent_path().empty() ? "." : target.parent_path(), temporary = temporary_of(target);
  if (target.filename().empty() || fs::is_directory(target))
    fail_input("{}: is a folder; name a file to write", target.string());
  if (!fs::exists(folder))
    fail_input("{}: cannot be written: there is no folder {}; make it, or name another file", target.string(),
               folder.string());
  if (!fs::is_directory(folder))
    fail_input("{}: cannot be written: {} is a file; name a file in a folder", target.string(), folder.string());
  // Only an attempt shows missing rights, read-only disks and full ones alike.
  const int file = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0644);
  if (file < 0)
    fail_input("{}: cannot be written: {}; name a file in another folder", target.string(), system_reason());
  ::close(file);
  std::error_code ignored;
  fs::remove(temporary, ignored);
}

void replace_file(const fs::path& target, const std::function<void(const fs::path&)>& write) {
  const fs::path temporary = temporary_of(target);
  std::error_code ec;
  try {
    write(temporary);
  } catch (...) {
    fs::remove(temporary, ec);
    throw;
  }
  fs::rename(temporary, target, ec);
  if (ec) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    fail_run("{}: cannot be written: {}", target.string(), ec.message());
  }
}

void write_bytes(const fs::path& path, const void* data, std::size_t size) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file < 0) fail_run("{}: cannot be written: {}", path.string(), system_reason());
  const char* p = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t n = ::write(file, p, size);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) {
      const std::string reason = system_reason();
      ::close(file);
      fail_run("{}: cannot be written: {}", path.string(), reason);
    }
    p += n;
    size -= static_cast<std::size_t>(n);
  }
  if (::close(file) != 0) fail_run("{}: cannot be written: {}", path.string(), system_reason());
}

void replace_file_text(const fs::path& target, std::string_view text) {
  replace_file(target, [&](const fs::path& temporary) { write_bytes(temporary, text.data(), text.size()); });
}

std::filesystem::path free_name(const std::string& stem, std::string_view extension) {
  for (int n = 1;; ++n)
    if (std::filesystem::path file = fmt::format("{}-{:03}{}", stem, n, extension); !std::filesystem::exists(file))
      return file;
}

std::string read_file(const fs::path& path) {
  if (fs::is_directory(path)) fail_input("{}: is a folder, a file is wanted", path.string());
  std::ifstream in(path, std::ios::binary);
  if (!in) fail_input("{}: cannot be read: {}", path.string(), system_reason());
  std::ostringstream text;
  text << in.rdbuf();
  return std::move(text).str();
}

}  // namespace dreampm
