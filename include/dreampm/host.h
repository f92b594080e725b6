// The host: a program that holds the library decides where lines go, and when to stop.
#pragma once
#include <string>

namespace dreampm {

/// Receives what the library reports, and is asked whether work shall stop. Methods are called on
/// the thread that called the library. A Host must outlive what it was given to. Several
/// Simulations may share one, which then has to be safe for the threads that they run on.
class Host {
 public:
  virtual ~Host() = default;
  /// A line for a person.
  virtual void info(const std::string& line) = 0;
  /// A line about what is likely wrong.
  virtual void warning(const std::string& line) = 0;
  /// A line about work that is under way.
  virtual void progress(const std::string& line) { info(line); }
  /// True if a progress line replaces the one before: then lines come five times a second, else
  /// every ten seconds.
  virtual bool rewrites_progress() const { return false; }
  /// Called after the last of them, also where work was broken off.
  virtual void progress_ends() {}
  /// Asked between steps: true ends the work with Interrupted, after the step.
  virtual bool stop_requested() { return false; }
};

/// Keeps silent and never stops.
class SilentHost final : public Host {
 public:
  void info(const std::string&) override {}
  void warning(const std::string&) override {}
};

}  // namespace dreampm
