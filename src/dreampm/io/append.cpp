#include "dreampm/io/append.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "dreampm/base/error.h"

namespace dreampm {

void append_text(const std::filesystem::path& file, const std::string& text) {
  const std::string name = file.string();
  const int out = ::open(file.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  if (out < 0) fail_run("{}: cannot be written: {}", name, system_reason());
  const off_t before = ::lseek(out, 0, SEEK_END);
  ssize_t n = 0;
  do n = ::write(out, text.data(), text.size());
  while (n < 0 && errno == EINTR);
  // A short write means that nothing more fits; half a row must not stay.
  std::string reason = n < 0                                   ? system_reason()
                       : n < static_cast<ssize_t>(text.size()) ? "no space for a whole row"
                                                               : "";
  if (n > 0 && !reason.empty() && ::ftruncate(out, before) != 0) reason += ", and half a row could not be taken back";
  if (::close(out) != 0 && reason.empty()) reason = system_reason();
  if (!reason.empty()) fail_run("{}: cannot be written: {}", name, reason);
}

}  // namespace dreampm
