// A playground on a thread of its own: the window never waits for the solver.
#pragma once
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "dreampm/host.h"
#include "dreampm/play/model/playground.h"

namespace dreampm::play {

class Worker {
 public:
  /// Wall clock of a tick [s], that a picture of what the user does is not too late: of one that
  /// shows what they just did, and of others. Either ends where something waits to be done.
  static constexpr double drawn_frame = 1.0 / 60, longest_tick = 0.03;

  /// Takes lines of the script of all that happens (`dreampm play --script`), on the worker's
  /// thread.
  using Record = std::function<void(const std::string& lines)>;

  /// Throws as Playground does. `record` gets the lines of each tick, and at last a comment
  /// with the hash of the world. What it throws ends the thread.
  Worker(PlayScene scene, const PlayOptions& options, Record record = {});
  ~Worker();

  /// The verb `replay FILE` plays a record again, until the user does something.
  /// To be done before the next tick, in the order of the calls; its number, counted from 1.
  std::uint64_t post(Action action);
  /// Whether the world stands still, such as while a film of it waits for its encoder: actions are
  /// done, and no tick. No record has it.
  void hold(bool holds);
  /// What it looked like after the last tick. Never null.
  std::shared_ptr<const Frame> latest() const;
  /// Throws what ended the thread, if anything did.
  void check() const;
  int threads() const { return threads_; }
  const std::string& backend() const { return backend_; }
  /// Ends the tick under way, and the thread: nothing is done any more.
  void stop();

 private:
  void run();
  /// Does what was posted; what tools do ends a record that is played again.
  void do_posted(const std::deque<Action>& actions, std::string& lines);
  void act(const Action& action, std::string& lines);
  /// Begins to play a record again; says where it cannot.
  void begin_replay(const std::string& file, std::string& lines);
  /// Up to the next tick of the record; its number of steps.
  std::optional<int> replay(std::string& lines);

  std::deque<std::string> script_;  ///< what is still to come of a record
  const std::unique_ptr<Host> host_;
  Playground playground_;
  const Record record_;
  const int threads_;
  const std::string backend_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<Action> posted_;
  std::atomic<bool> waits_ = false;  ///< whether anything is posted
  std::uint64_t numbers_ = 0;
  std::shared_ptr<const Frame> latest_;
  std::exception_ptr failure_;
  bool ends_ = false, holds_ = false;
  std::thread thread_;
};

}  // namespace dreampm::play
