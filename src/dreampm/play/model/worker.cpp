#include "dreampm/play/model/worker.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <sstream>
#include <utility>

#include "dreampm/base/file.h"
#include "dreampm/base/host.h"
#include "dreampm/error.h"

namespace dreampm::play {
namespace {

/// Lines go where they went. A signal breaks no tick off: it closes the window, and what was played
/// until then is whole.
class UninterruptedHost final : public Host {
 public:
  explicit UninterruptedHost(Host& to) : to_(to) {}
  void info(const std::string& line) override { to_.info(line); }
  void warning(const std::string& line) override { to_.warning(line); }

 private:
  Host& to_;
};

PlayOptions with_host(PlayOptions options, Host& host) {
  options.simulation.host = &host;
  return options;
}

bool passes(const Action& action) {
  return std::any_of(verbs().begin(), verbs().end(), [&](const Verb& v) { return v.name == action.verb && v.passes; });
}

bool is_recorded(const Action& action) {
  return std::none_of(verbs().begin(), verbs().end(),
                      [&](const Verb& v) { return v.name == action.verb && !v.recorded; });
}

}  // namespace

Worker::Worker(PlayScene scene, const PlayOptions& options, Record record)
    : host_(std::make_unique<UninterruptedHost>(options.simulation.host ? *options.simulation.host : current_host())),
      playground_(std::move(scene), with_host(options, *host_)),
      record_(std::move(record)),
      threads_(playground_.threads()),
      backend_(playground_.backend()) {
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
    waits_ = true;
    number = ++numbers_;
  }
  wake_.notify_one();
  return number;
}

void Worker::hold(bool holds) {
  {
    const std::lock_guard lock(mutex_);
    if (std::exchange(holds_, holds) == holds) return;
  }
  wake_.notify_one();
}

std::shared_ptr<const Frame> Worker::latest() const {
  const std::lock_guard lock(mutex_);
  return latest_;
}

void Worker::check() const {
  const std::lock_guard lock(mutex_);
  if (failure_) std::rethrow_exception(failure_);
}

void Worker::act(const Action& action, std::string& lines) {
  try {
    playground_.act(action);
    if (is_recorded(action)) lines += action.text() + "\n";
  } catch (const Error&) {
    // The frame's message says it: what cannot be done, or what the machine did not do.
    if (is_recorded(action)) lines += "refused " + action.text() + "\n";
  }
}

void Worker::do_posted(const std::deque<Action>& actions, std::string& lines) {
  for (const Action& action : actions) {
    if (action.verb == "replay") {
      begin_replay(action.words.empty() ? "" : action.words[0], lines);
      continue;
    }
    // Of a record that goes on, what a pointer pushes that only passes is left out.
    if (!script_.empty() && is_recorded(action)) {
      if (passes(action)) continue;
      script_.clear();
      playground_.tell("the record ends here: you go on");
    }
    act(action, lines);
  }
}

void Worker::begin_replay(const std::string& file, std::string& lines) {
  script_.clear();
  try {
    std::istringstream text(read_file(file));
    for (std::string line; std::getline(text, line);)
      if (!line.empty() && !line.starts_with('#')) script_.push_back(line);
    const Action first = script_.empty() ? Action{} : Action::parse(script_.front());
    if (first.verb != "plays") throw InputError(fmt::format("{}: is no record of a window", file));
    script_.pop_front();
    act({"open", {first.word(0)}}, lines);
    playground_.tell(fmt::format("plays {} again", file));
  } catch (const std::exception& e) {
    script_.clear();
    playground_.tell(e.what(), true);
  }
}

std::optional<int> Worker::replay(std::string& lines) {
  while (!script_.empty()) {
    const std::string line = script_.front();
    script_.pop_front();
    try {
      Action action = Action::parse(line);
      if (action.verb == "refused") action = Action::parse(line.substr(line.find(' ')));
      if (action.verb == "steps") {
        if (script_.empty()) playground_.tell("the record has ended");
        return action.whole(0, 1000000);
      }
      if (action.verb == "frames") continue;  // of a script by hand: as fast as the machine goes
      act(action, lines);
    } catch (const InputError& e) {
      script_.clear();
      playground_.tell(e.what(), true);
    }
  }
  playground_.tell("the record has ended");
  return std::nullopt;
}

void Worker::run() {
  using WallClock = std::chrono::steady_clock;
  // A world that stands still is looked at more seldom.
  constexpr std::chrono::microseconds between{16667}, still_between{100000};
  std::string lines;
  const auto note = [&](const std::string& line) { lines += line + "\n"; };
  const auto write = [&] {
    if (record_ && !lines.empty()) record_(lines);
    lines.clear();
  };
  try {
    while (true) {
      const auto began = WallClock::now();
      std::deque<Action> actions;
      bool ends = false, holds = false;
      {
        const std::lock_guard lock(mutex_);
        ends = ends_, holds = holds_;
        actions.swap(posted_);
        waits_ = false;
      }
      // What was asked for right before the end is done too.
      do_posted(actions, lines);
      if (holds && !ends) {
        write();
        std::shared_ptr<const Frame> frame = playground_.frame();
        std::unique_lock lock(mutex_);
        latest_ = std::move(frame);
        wake_.wait(lock, [&] { return ends_ || !holds_ || !posted_.empty(); });
        continue;
      }
      std::optional<int> counted;
      if (!script_.empty() && !ends) counted = replay(lines);
      if (ends) {
        note(fmt::format("# hash {:016x}", playground_.hash()));
        return write();
      }
      write();  // also where this tick fails
      const bool acted = !actions.empty();
      // What the user does next ends the tick under way: its picture is not that much later.
      bool gave_way = false;
      Playground::Limit limit{counted,
                              longest_tick,
                              {},
                              [&](double seconds) { return seconds > drawn_frame && acted; },
                              [&] { return gave_way = waits_; }};
      if (counted) limit.seconds.reset();
      const int steps = playground_.tick(limit);
      note(fmt::format("steps {}", steps));
      write();
      std::shared_ptr<const Frame> frame = playground_.frame();
      std::unique_lock lock(mutex_);
      latest_ = std::move(frame);
      const bool stands = steps == 0 && latest_->settings.paused;
      wake_.wait_until(lock, began + (stands ? still_between : between),
                       [&] { return ends_ || ((steps == 0 || gave_way) && !posted_.empty()); });
    }
  } catch (...) {
    // Whoever draws the frames throws it on.
    const std::lock_guard lock(mutex_);
    failure_ = std::current_exception();
  }
}

}  // namespace dreampm::play
