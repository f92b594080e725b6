// The host that lines and questions of this thread go to.
#pragma once
#include "dreampm/host.h"

namespace dreampm {

/// The innermost HostScope's of this thread; without one, that of the process: lines go to stderr,
/// and a signal caught by catch_interrupts() requests a stop.
Host& current_host();

/// While it lives, `host` is the current one of this thread. A null pointer changes nothing.
class HostScope {
 public:
  explicit HostScope(Host* host);
  ~HostScope();
  HostScope(const HostScope&) = delete;
  HostScope& operator=(const HostScope&) = delete;

 private:
  Host* outer_;
};

}  // namespace dreampm
