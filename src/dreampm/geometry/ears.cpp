#include "dreampm/geometry/ears.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace dreampm {
namespace {

using Corners = std::vector<std::array<double, 2>>;

/// Twice the area of the triangle of three corners; below 0 where it turns to the right.
double area(const Corners& at, std::size_t a, std::size_t b, std::size_t c) {
  return (at[b][0] - at[a][0]) * (at[c][1] - at[a][1]) - (at[b][1] - at[a][1]) * (at[c][0] - at[a][0]);
}

/// A polygon from which ears are cut. Only corners that do not turn to the left can lie in an ear,
/// and an ear that is cut changes its two neighbors alone (D. Eberly, "Triangulation by Ear
/// Clipping", 2002).
class Ring {
 public:
  explicit Ring(const Corners& at) : at_(at), before_(at.size()), after_(at.size()) {
    const std::size_t n = at.size();
    for (std::size_t i = 0; i < n; ++i) before_[i] = (i + n - 1) % n, after_[i] = (i + 1) % n;
    for (std::size_t i = 0; i < n; ++i) look_at_turn(i);
    for (std::size_t i = 0; i < n; ++i) look_for_ear(i);
  }
  std::vector<std::array<std::size_t, 3>> cut() {
    std::vector<std::array<std::size_t, 3>> triangles;
    std::size_t left = at_.size(), first = 0;
    for (; left > 3 && !ears_.empty(); --left) {
      const std::size_t i = *ears_.begin(), a = before_[i], b = after_[i];
      triangles.push_back({a, i, b});
      ears_.erase(i), inward_.erase(key(i));
      after_[a] = b, before_[b] = a;
      if (i == first) first = b;
      look_at_turn(a), look_at_turn(b);
      look_for_ear(a), look_for_ear(b);
    }
    // One that crosses itself: a fan of what is left is as good as any.
    for (std::size_t i = after_[first]; after_[i] != first; i = after_[i]) triangles.push_back({first, i, after_[i]});
    return triangles;
  }

 private:
  bool turns_left(std::size_t i) const { return area(at_, before_[i], i, after_[i]) > 0; }
  /// A place that is no number is refused later, by the one who has the file's name.
  std::pair<double, std::size_t> key(std::size_t i) const { return {std::isnan(at_[i][0]) ? 0 : at_[i][0], i}; }
  void look_at_turn(std::size_t i) {
    if (turns_left(i))
      inward_.erase(key(i));
    else
      inward_.insert(key(i));
  }
  void look_for_ear(std::size_t i) {
    if (is_ear(before_[i], i, after_[i]))
      ears_.insert(i);
    else
      ears_.erase(i);
  }
  /// True if the triangle a b c can be cut off: it turns to the left, and no other corner lies in
  /// it.
  bool is_ear(std::size_t a, std::size_t b, std::size_t c) const {
    if (!turns_left(b)) return false;
    const auto [low, high] = std::minmax({key(a).first, key(b).first, key(c).first});
    for (auto p = inward_.lower_bound({low, 0}); p != inward_.end() && p->first <= high; ++p) {
      const std::size_t i = p->second;
      if (at_[i] == at_[a] || at_[i] == at_[b] || at_[i] == at_[c]) continue;
      if (area(at_, a, b, i) >= 0 && area(at_, b, c, i) >= 0 && area(at_, c, a, i) >= 0) return false;
    }
    return true;
  }

  const Corners& at_;
  std::vector<std::size_t> before_, after_;
  std::set<std::pair<double, std::size_t>> inward_;  ///< by place along the first axis
  std::set<std::size_t> ears_;
};

}  // namespace

std::vector<std::array<std::size_t, 3>> cut_polygon(const Corners& at) {
  const std::size_t n = at.size();
  bool convex = true;
  for (std::size_t i = 0; i < n; ++i) convex = convex && area(at, i, (i + 1) % n, (i + 2) % n) >= 0;
  if (!convex) return Ring(at).cut();
  std::vector<std::array<std::size_t, 3>> fan;
  for (std::size_t k = 2; k < n; ++k) fan.push_back({0, k - 1, k});
  return fan;
}

}  // namespace dreampm
