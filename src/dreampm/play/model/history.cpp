#include "dreampm/play/model/history.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace dreampm::play {
namespace {

std::uint64_t bytes_of(const std::deque<StateSnapshot>& moments) {
  std::uint64_t bytes = 0;
  for (const StateSnapshot& m : moments) bytes += m.snapshot.bytes();
  return bytes;
}

}  // namespace

void History::keep(StateSnapshot now) {
  moments_.resize(at_);
  moments_.push_back(std::move(now));
  while (moments_.size() > 1 && moments_.front().played < moments_.back().played - reach) moments_.pop_front();
  at_ = moments_.size();
  fit();
}

const StateSnapshot* History::seek(double played) {
  if (moments_.empty()) return nullptr;
  const auto off = [&](const StateSnapshot& m) { return std::abs(m.played - played); };
  const auto nearest =
      std::min_element(moments_.begin(), moments_.end(),
                       [&](const StateSnapshot& a, const StateSnapshot& b) { return off(a) < off(b); });
  at_ = static_cast<std::size_t>(nearest - moments_.begin()) + 1;
  return &*nearest;
}

void History::before_edit(const std::string& what, const std::function<StateSnapshot()>& now) {
  if (what == last_edit_) return;
  last_edit_ = what;
  redo_.clear();
  undo_.push_back(now());
  ++edits_;
  fit();
}

StateSnapshot History::swap_top(std::deque<StateSnapshot>& from, std::deque<StateSnapshot>& to, StateSnapshot now) {
  last_edit_.clear();
  StateSnapshot then = std::move(from.back());
  from.pop_back();
  to.push_back(std::move(now));
  const auto later =
      std::find_if(moments_.begin(), moments_.end(), [&](const StateSnapshot& m) { return m.played > then.played; });
  at_ = static_cast<std::size_t>(later - moments_.begin());
  return then;
}

StateSnapshot History::undo(StateSnapshot now) { return swap_top(undo_, redo_, std::move(now)); }
StateSnapshot History::redo(StateSnapshot now) { return swap_top(redo_, undo_, std::move(now)); }

void History::fit() {
  for (; moments_.size() > 1 && bytes_of(moments_) > bytes_ / 2; moments_.pop_front()) at_ -= at_ > 0;
  while (undo_.size() > most_edits || (undo_.size() > 1 && bytes_of(undo_) > bytes_ / 2)) undo_.pop_front();
}

}  // namespace dreampm::play
