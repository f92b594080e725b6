// The past of a playground: snapshots of the last seconds to go back to, and of what edits did.
#pragma once
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "dreampm/play/model/control.h"
#include "dreampm/simulation.h"

namespace dreampm::play {

struct LoadedScene;

/// A moment to go back to.
struct StateSnapshot {
  std::shared_ptr<const LoadedScene> loaded;  ///< what was played
  Snapshot snapshot;
  WorldSettings world;
  double played = 0;  ///< s of playing since the start, which going back takes back
};

/// Keeps what fits into `bytes` of memory, half of it for edits and half for the last seconds.
class History {
 public:
  static constexpr std::size_t most_edits = 50;
  static constexpr double reach = 5;       ///< s of playing that can be gone back
  static constexpr double interval = 0.1;  ///< s between moments

  explicit History(std::uint64_t bytes) : bytes_(bytes) {}

  /// Whether the latest moment is more than `interval` ago, or moments lie ahead that were gone
  /// back over.
  bool is_due(double played) const {
    return at_ == 0 || at_ < moments_.size() || played >= moments_[at_ - 1].played + interval;
  }
  /// Moments after one that was gone back to are forgotten.
  void keep(StateSnapshot now);
  /// The moment nearest to that time of playing [s]; null without moments. Goes there.
  const StateSnapshot* seek(double played);
  /// The latest moment; null without.
  const StateSnapshot* latest() const { return at_ > 0 ? &moments_[at_ - 1] : nullptr; }
  double first() const { return moments_.empty() ? 0 : moments_.front().played; }
  double last() const { return moments_.empty() ? 0 : moments_.back().played; }

  /// Before an edit. Of edits alike, by `what`, that follow one another only the first is kept,
  /// until `separate`.
  void before_edit(const std::string& what, const std::function<StateSnapshot()>& now);
  void separate() { last_edit_.clear(); }
  /// The last edit was refused after all.
  void forget_edit() { undo_.pop_back(), separate(), --edits_; }
  /// What before_edit kept so far.
  std::uint64_t edits() const { return edits_; }
  const std::string& last_edit() const { return last_edit_; }
  bool can_undo() const { return !undo_.empty(); }
  bool can_redo() const { return !redo_.empty(); }
  /// Swaps `now` for what was before the last edit; and back again. The moments of the last seconds
  /// lead up to it then.
  StateSnapshot undo(StateSnapshot now);
  StateSnapshot redo(StateSnapshot now);
  void forget() { *this = History(bytes_); }
  /// From now on.
  void limit(std::uint64_t bytes) { bytes_ = bytes, fit(); }

 private:
  void fit();
  StateSnapshot swap_top(std::deque<StateSnapshot>& from, std::deque<StateSnapshot>& to, StateSnapshot now);

  std::uint64_t bytes_;
  std::deque<StateSnapshot> moments_;
  std::size_t at_ = 0;  ///< moments until now; those behind were gone back over
  std::deque<StateSnapshot> undo_, redo_;
  std::string last_edit_;
  std::uint64_t edits_ = 0;
};

}  // namespace dreampm::play
