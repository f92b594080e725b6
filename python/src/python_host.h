// The host of what Python calls: lines go to logging, signals to the handlers of Python.
#pragma once
#include <nanobind/nanobind.h>

#include <chrono>
#include <optional>
#include <string>

#include "dreampm/error.h"
#include "dreampm/host.h"

namespace dreampm::python {

/// Lines go to the logger "dreampm" of Python's `logging`. Whether to stop is decided by Python's
/// handlers of signals, which are asked twenty times a second: each time the GIL has to be waited
/// for. Methods may be called with or without the GIL.
class PythonHost final : public Host {
 public:
  void info(const std::string& line) override { log("info", line); }
  void warning(const std::string& line) override { log("warning", line); }
  bool stop_requested() override;

  /// Calls body without the GIL. Where a handler of a signal raised, what it raised is thrown in
  /// place of Interrupted.
  template <class Body>
  auto run(const Body& body) {
    raised_.reset();
    try {
      const nanobind::gil_scoped_release free;
      return body();
    } catch (const Interrupted&) {
      if (!raised_) throw;
      const nanobind::python_error raised = std::move(*raised_);
      raised_.reset();
      throw raised;
    }
  }

 private:
  static void log(const char* level, const std::string& line);

  std::chrono::steady_clock::time_point asked_{};
  std::optional<nanobind::python_error> raised_;
};

}  // namespace dreampm::python
