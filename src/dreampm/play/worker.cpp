#include "dreampm/play/worker.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "dreampm/base/host.h"
#include "dreampm/error.h"

namespace dreampm::play {
namespace {

/// Lines go where they went. A signal breaks no tick off: it closes the window, and what was played
/// until then is whole.
class Unhurried final : public Host {
 public:
  explicit Unhurried(Host& to) : to_(to) {}
  void info(const std::string& line) override { to_.info(line); }
  void warning(const std::string& line) override { to_.warning(line); }

 private:
  Host& to_;
};

PlayOptions with_host(PlayOptions options, Host& host) {
  options.simulation.host = &host;
  return options;
}

bool is_recorded(const Action& action) {
  return std::none_of(verbs().begin(), verbs().end(),
                      [&](const Verb& v) { return v.name == action.verb && !v.recorded; });
}

}  // namespace

Worker::Worker(Stage stage, const PlayOptions& options, Record record)
    : host_(std::make_unique<Unhurried>(options.simulation.host ? *options.simulation.host : current_host())),
      playground_(std::move(stage), with_host(options, *host_)),
      record_(std::move(record)),
      threads_(playground_.threads()),
      isa_(playground_.isa()) {
  latest_ = playground_.frame();
  thread_ = std::thread([this] { run(); });
}

Worker::~Worker() { stop(); }

void Worker::stop() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  wake_.notify_one();
  if (thread_.joinable()) thread_.join();
}

std::uint64_t Worker::post(Action action) {
  std::uint64_t number = 0;
  {
    const std::lock_guard lock(mutex_);
    posted_.push_back(std::move(action));
    number = ++numbers_;
  }
  wake_.notify_one();
  return number;
}

std::shared_ptr<const Frame> Worker::latest() const {
  const std::lock_guard lock(mutex_);
  return latest_;
}

void Worker::check() const {
  const std::lock_guard lock(mutex_);
  if (failure_) std::rethrow_exception(failure_);
}

void Worker::run() {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::microseconds drawn_frame{16667};
  std::string lines;
  const auto note = [&](const std::string& line) { lines += line + "\n"; };
  const auto write = [&] {
    if (record_ && !lines.empty()) record_(lines);
    lines.clear();
  };
  try {
    while (true) {
      const auto began = Clock::now();
      std::deque<Action> actions;
      bool ends = false;
      {
        const std::lock_guard lock(mutex_);
        ends = ends_;
        actions.swap(posted_);
      }
      // What was asked for right before the end is done too.
      for (const Action& action : actions) {
        try {
          playground_.act(action);
          if (is_recorded(action)) note(action.text());
        } catch (const Error&) {
          // The frame's message says it: what cannot be done, or what the machine did not do.
          if (is_recorded(action)) note("refused " + action.text());
        }
      }
      if (ends) {
        note(fmt::format("# hash {:016x}", playground_.hash()));
        return write();
      }
      write();  // also where this tick fails
      const int steps = playground_.tick({std::nullopt, longest_tick});
      note(fmt::format("steps {}", steps));
      write();
      std::shared_ptr<const Frame> frame = playground_.frame();
      std::unique_lock lock(mutex_);
      latest_ = std::move(frame);
      wake_.wait_until(lock, began + drawn_frame, [&] { return ends_ || (steps == 0 && !posted_.empty()); });
    }
  } catch (...) {
    // Whoever draws the frames throws it on.
    const std::lock_guard lock(mutex_);
    failure_ = std::current_exception();
  }
}

}  // namespace dreampm::play
