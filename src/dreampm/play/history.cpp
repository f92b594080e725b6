#include "dreampm/play/history.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace dreampm::play {
namespace {

std::uint64_t bytes_of(const std::deque<Moment>& moments) {
  std::uint64_t bytes = 0;
  for (const Moment& m : moments) bytes += m.snapshot.bytes();
  return bytes;
}

}  // namespace

void History::keep(Moment now) {
  moments_.resize(at_);
  moments_.push_back(std::move(now));
  while (moments_.size() > 1 && moments_.front().played < moments_.back().played - reach) moments_.pop_front();
  at_ = moments_.size();
  fit();
}

const Moment* History::seek(double played) {
  if (moments_.empty()) return nullptr;
  const auto off = [&](const Moment& m) { return std::abs(m.played - played); };
  const auto nearest = std::min_element(moments_.begin(), moments_.end(),
                                        [&](const Moment& a, const Moment& b) { return off(a) < off(b); });
  at_ = static_cast<std::size_t>(nearest - moments_.begin()) + 1;
  return &*nearest;
}

void History::before_edit(const std::string& what, const std::function<Moment()>& now) {
  if (what == last_edit_) return;
  last_edit_ = what;
  redo_.clear();
  undo_.push_back(now());
  ++edits_;
  fit();
}

Moment History::swap_top(std::deque<Moment>& from, std::deque<Moment>& to, Moment now) {
  last_edit_.clear();
  Moment then = std::move(from.back());
  from.pop_back();
  to.push_back(std::move(now));
  const auto later =
      std::find_if(moments_.begin(), moments_.end(), [&](const Moment& m) { return m.played > then.played; });
  at_ = static_cast<std::size_t>(later - moments_.begin());
  return then;
}

Moment History::undo(Moment now) { return swap_top(undo_, redo_, std::move(now)); }
Moment History::redo(Moment now) { return swap_top(redo_, undo_, std::move(now)); }

void History::fit() {
  for (; moments_.size() > 1 && bytes_of(moments_) > bytes_ / 2; moments_.pop_front()) at_ -= at_ > 0;
  while (undo_.size() > most_edits || (undo_.size() > 1 && bytes_of(undo_) > bytes_ / 2)) undo_.pop_front();
}

}  // namespace dreampm::play
