#include "dreampm/base/host.h"

#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <utility>

#include "dreampm/base/interrupt.h"

namespace dreampm {
namespace {

class ProcessHost final : public Host {
 public:
  ProcessHost() : logger_("dreampm", std::make_shared<spdlog::sinks::stderr_color_sink_mt>(colors())) {
    logger_.set_pattern("%^%v%$");
  }
  void info(const std::string& line) override { logger_.info(line); }
  void warning(const std::string& line) override { logger_.warn("warning: " + line); }
  void progress(const std::string& line) override {
    if (!terminal_) return info(line);
    fmt::print(stderr, "\r\x1b[K{}", line);
    std::fflush(stderr);
    open_line_ = true;
  }
  bool rewrites_progress() const override { return terminal_; }
  void progress_ends() override {
    if (open_line_.exchange(false)) std::fputs("\n", stderr);
  }
  bool stop_requested() override { return signal_caught(); }

 private:
  /// The rule of no-color.org: any value of NO_COLOR counts, unless it is empty.
  static spdlog::color_mode colors() {
    const char* const none = std::getenv("NO_COLOR");
    return none && *none ? spdlog::color_mode::never : spdlog::color_mode::automatic;
  }
  spdlog::logger logger_;
  const bool terminal_ = isatty(STDERR_FILENO) != 0;
  std::atomic<bool> open_line_ = false;
};

// The scope of a host is that of the calls below it, which are on one thread.
thread_local Host* innermost = nullptr;

}  // namespace

Host& current_host() {
  static ProcessHost process;
  return innermost ? *innermost : process;
}

HostScope::HostScope(Host* host) : outer_(std::exchange(innermost, host ? host : innermost)) {}
HostScope::~HostScope() { innermost = outer_; }

}  // namespace dreampm
