// Lines for a person: to the current host, and to a run's log.txt while one is open.
#pragma once
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "dreampm/base/host.h"

namespace dreampm {

void log_info(const std::string& line);
void log_warning(const std::string& line);
template <class... Args>
void info(fmt::format_string<Args...> text, Args&&... args) {
  log_info(fmt::format(text, std::forward<Args>(args)...));
}
template <class... Args>
void warn(fmt::format_string<Args...> text, Args&&... args) {
  log_warning(fmt::format(text, std::forward<Args>(args)...));
}

/// While it lives, lines of this thread are also appended to `file` with date and time.
class LogFile {
 public:
  explicit LogFile(const std::filesystem::path& file);
  ~LogFile();
  LogFile(const LogFile&) = delete;
  LogFile& operator=(const LogFile&) = delete;

 private:
  std::unique_ptr<Host> host_;
  HostScope scope_;
};

}  // namespace dreampm
