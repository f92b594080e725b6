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

void replace_file(const fs::path& target, const std::function<void(const fs::path&)>& write) {
  fs::path temporary = target;
  temporary += ".part";
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

std::string read_file(const fs::path& path) {
  if (fs::is_directory(path)) fail_input("{}: is a folder, a file is wanted", path.string());
  std::ifstream in(path, std::ios::binary);
  if (!in) fail_input("{}: cannot be read: {}", path.string(), system_reason());
  std::ostringstream text;
  text << in.rdbuf();
  return std::move(text).str();
}

}  // namespace dreampm
