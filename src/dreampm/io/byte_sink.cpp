#include "dreampm/io/byte_sink.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

#include "dreampm/base/error.h"

namespace dreampm {
namespace {
constexpr std::size_t piece = std::size_t(4) << 20;
}

ByteSink::ByteSink(const std::filesystem::path& path, const std::filesystem::path& target)
    : target_(target.string()), file_(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644)) {
  if (file_ < 0) fail();
  buffer_.reserve(piece);
}

ByteSink::~ByteSink() {
  if (file_ >= 0) ::close(file_);
}

void ByteSink::fail() { fail_run("{}: cannot be written: {}", target_, system_reason()); }

void ByteSink::bytes(const void* data, std::size_t size) {
  if (buffer_.size() + size > piece) flush();
  buffer_.append(static_cast<const char*>(data), size);
}

void ByteSink::flush() {
  const char* p = buffer_.data();
  std::size_t left = buffer_.size();
  while (left > 0) {
    const ssize_t n = ::write(file_, p, left);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) fail();
    p += n;
    left -= static_cast<std::size_t>(n);
  }
  buffer_.clear();
}

void ByteSink::close() {
  flush();
  const int file = file_;
  file_ = -1;
  if (::close(file) != 0) fail();
}

}  // namespace dreampm
