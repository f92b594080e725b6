// Lines for a person: to stderr, and to a run's log.txt while one is open.
#pragma once
#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <utility>

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

/// While it lives, log lines are also appended to `file` with date and time.
class LogFile {
 public:
  explicit LogFile(const std::filesystem::path& file);
  ~LogFile();
  LogFile(const LogFile&) = delete;
  LogFile& operator=(const LogFile&) = delete;
};

}  // namespace dreampm
