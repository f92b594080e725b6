#include "dreampm/base/log.h"

#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/spdlog.h>

#include "dreampm/base/error.h"

namespace dreampm {
namespace {

/// Forwards to another host, and keeps the lines in a file.
class FileHost final : public Host {
 public:
  FileHost(const std::filesystem::path& file, Host& outer) : outer_(outer) {
    try {
      logger_ =
          std::make_unique<spdlog::logger>("file", std::make_shared<spdlog::sinks::basic_file_sink_mt>(file.string()));
    } catch (const spdlog::spdlog_ex& e) {
      fail_run("{}: the log cannot be written: {}", file.string(), e.what());
    }
    logger_->set_pattern("%Y-%m-%d %H:%M:%S %v");
    logger_->flush_on(spdlog::level::info);
  }
  void info(const std::string& line) override { outer_.info(line), logger_->info(line); }
  void warning(const std::string& line) override { outer_.warning(line), logger_->warn("warning: " + line); }
  void progress(const std::string& line) override {
    outer_.progress(line);
    if (!rewrites_progress()) logger_->info(line);
  }
  bool rewrites_progress() const override { return outer_.rewrites_progress(); }
  void progress_ends() override { outer_.progress_ends(); }
  bool stop_requested() override { return outer_.stop_requested(); }

 private:
  Host& outer_;
  std::unique_ptr<spdlog::logger> logger_;
};

}  // namespace

void log_info(const std::string& line) { current_host().info(line); }
void log_warning(const std::string& line) { current_host().warning(line); }

LogFile::LogFile(const std::filesystem::path& file)
    : host_(std::make_unique<FileHost>(file, current_host())), scope_(host_.get()) {}
LogFile::~LogFile() = default;

}  // namespace dreampm
