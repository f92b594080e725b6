#include "dreampm/base/interrupt.h"

#include <csignal>

#include "dreampm/base/host.h"

namespace dreampm {
namespace {
// A signal handler can reach nothing but a static flag.
volatile std::sig_atomic_t flag = 0;
extern "C" void on_signal(int signal_number) {
  if (flag) {
    std::signal(signal_number, SIG_DFL);
    std::raise(signal_number);
  }
  flag = 1;
}
}  // namespace

void catch_interrupts() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
}

bool signal_caught() { return flag != 0; }
bool interrupted() { return current_host().stop_requested(); }

}  // namespace dreampm
