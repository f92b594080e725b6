// Room for new particles within the columns of a set.
#pragma once
#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "dreampm/base/parallel.h"

namespace dreampm {

/// Particles that come into the blocks of a set, each behind those that its block has: those after
/// them move up. Only what moves is touched, in parts side by side.
class ColumnRoom {
 public:
  /// `block_start`: before, and after.
  ColumnRoom(std::span<const std::uint32_t> before, std::span<const std::uint32_t> after) {
    for (std::size_t b = 0; b + 1 < before.size(); ++b) {
      const std::uint32_t count = before[b + 1] - before[b];
      if (count == 0) continue;
      if (!runs_.empty() && runs_.back().to - runs_.back().from == after[b] - before[b])
        runs_.back().count += count;
      else
        runs_.push_back({before[b], after[b], count});
    }
    const std::uint32_t size = after.back(), farthest = size - before.back();
    // The first rows stay where they are.
    first_ = !runs_.empty() && runs_.front().to == runs_.front().from ? runs_.front().count : 0;
    parts_ = std::min<std::size_t>(most_parts, (size - first_) / std::max<std::uint32_t>(least_part, 4 * farthest));
    parts_ = std::max<std::size_t>(parts_, 1);
  }

  /// The column has its new size, and what it held is where it was; puts it where it belongs. What
  /// lies between is left for the new.
  template <class T>
  void open(std::span<T> column) const {
    if (runs_.empty() || first_ == column.size()) return;
    std::vector<std::vector<T>> from_below(parts_);
    // Rows that come from a part below go first, before that part overwrites them.
    parallel_for(parts_ - 1, 1, [&](std::size_t i) {
      const std::size_t begin = begin_of(i + 1, column.size());
      for_moves(begin, begin_of(i + 2, column.size()), [&](std::size_t from, std::size_t, std::size_t count) {
        if (from >= begin) return;
        const auto source = column.begin() + static_cast<std::ptrdiff_t>(from);
        from_below[i + 1].insert(from_below[i + 1].end(), source,
                                 source + static_cast<std::ptrdiff_t>(std::min(count, begin - from)));
      });
    });
    parallel_for(parts_, 1, [&](std::size_t i) {
      const std::size_t begin = begin_of(i, column.size());
      auto kept = from_below[i].begin();
      for_moves(begin, begin_of(i + 1, column.size()), [&](std::size_t from, std::size_t to, std::size_t count) {
        const std::size_t below = from < begin ? std::min(count, begin - from) : 0;
        std::copy_backward(column.begin() + static_cast<std::ptrdiff_t>(from + below),
                           column.begin() + static_cast<std::ptrdiff_t>(from + count),
                           column.begin() + static_cast<std::ptrdiff_t>(to + count));
        std::copy_n(kept, below, column.begin() + static_cast<std::ptrdiff_t>(to));
        kept += static_cast<std::ptrdiff_t>(below);
      });
    });
  }

 private:
  static constexpr std::size_t most_parts = 64;
  static constexpr std::uint32_t least_part = 1 << 14;
  /// Particles that move by the same number of places.
  struct Run {
    std::uint32_t from, to, count;
  };
  /// Returns the first row of part `i` of a column of that size.
  std::size_t begin_of(std::size_t i, std::size_t size) const { return first_ + (size - first_) * i / parts_; }
  /// Calls body(from, to, count) for what comes to [begin, end), the last first.
  template <class Body>
  void for_moves(std::size_t begin, std::size_t end, const Body& body) const {
    auto run =
        std::lower_bound(runs_.begin(), runs_.end(), end, [](const Run& r, std::size_t at) { return r.to < at; });
    while (run != runs_.begin()) {
      --run;
      const std::size_t low = std::max<std::size_t>(run->to, begin),
                        high = std::min<std::size_t>(run->to + run->count, end);
      if (run->to + run->count <= begin) return;
      if (low < high) body(run->from + (low - run->to), low, high - low);
    }
  }

  std::vector<Run> runs_;  ///< in their order
  std::size_t first_ = 0, parts_ = 1;
};

}  // namespace dreampm
