#include "dreampm/base/host.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <memory>
#include <utility>

#include "dreampm/base/interrupt.h"

namespace dreampm {
namespace {

class ProcessHost final : public Host {
 public:
  ProcessHost() : logger_("dreampm", std::make_shared<spdlog::sinks::stderr_color_sink_mt>()) {
    logger_.set_pattern("%^%v%$");
  }
  void info(const std::string& line) override { logger_.info(line); }
  void warning(const std::string& line) override { logger_.warn("warning: " + line); }
  bool stop_requested() override { return signal_caught(); }

 private:
  spdlog::logger logger_;
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
