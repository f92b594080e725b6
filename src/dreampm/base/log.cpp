#include "dreampm/base/log.h"

#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <memory>

#include "dreampm/base/error.h"

namespace dreampm {
namespace {
spdlog::logger& logger() {
  static auto instance = [] {
    auto sink = std::make_shared<spdlog::sinks::stderr_color_sink_mt>();
    sink->set_pattern("%^%v%$");
    return std::make_shared<spdlog::logger>("dreampm", sink);
  }();
  return *instance;
}
}  // namespace

void log_info(const std::string& line) { logger().info(line); }
void log_warning(const std::string& line) { logger().warn("warning: " + line); }

LogFile::LogFile(const std::filesystem::path& file) {
  try {
    auto sink = std::make_shared<spdlog::sinks::basic_file_sink_mt>(file.string());
    sink->set_pattern("%Y-%m-%d %H:%M:%S %v");
    logger().sinks().push_back(sink);
    logger().flush_on(spdlog::level::info);
  } catch (const spdlog::spdlog_ex& e) {
    fail_run("{}: the log cannot be written: {}", file.string(), e.what());
  }
}

LogFile::~LogFile() { logger().sinks().pop_back(); }

}  // namespace dreampm
