// Unions, differences and intersections. All three are the intersection of sides: a union is what
// is left of the intersection of the parts' outsides, a difference intersects the first part with
// the others' outsides.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "dreampm/geometry/region.h"

namespace dreampm {
namespace {

struct Felt {
  double distance;
  Vec3d normal;
};
/// The edge of a sheet as seen from a place on it.
struct Edge {
  double distance;  ///< m
  Vec3d way;        ///< to where a face beyond it is felt [m]
};

class Boolean final : public Region {
 public:
  using Op = BooleanShape::Op;
  Boolean(Op op, std::vector<std::shared_ptr<const Region>> parts, double same)
      : first_(op == Op::unite ? -1 : 1),
        other_(op == Op::intersection ? 1 : -1),
        op_(op),
        parts_(std::move(parts)),
        same_(same) {
    for (const auto& part : parts_)
      if (const Vec3d size = part->bounds().size(); is_finite(size))
        far_ = std::max({far_, 0.5 * size.x, 0.5 * size.y, 0.5 * size.z});
  }

  double distance(const Vec3d& p) const override { return first_ * distance_to(parts_.size(), p); }
  void distances(const PointColumns& points, double* to) const override {
    constexpr std::size_t length = 64;
    std::array<double, length> all, part;
    for (std::size_t begin = 0; begin < points.count; begin += length) {
      const PointColumns some{{points.at[0] + begin, points.at[1] + begin, points.at[2] + begin},
                              std::min(length, points.count - begin)};
      parts_[0]->distances(some, all.data());
      for (std::size_t n = 0; n < some.count; ++n) all[n] *= first_;
      for (std::size_t i = 1; i < parts_.size(); ++i) {
        parts_[i]->distances(some, part.data());
        for (std::size_t n = 0; n < some.count; ++n)
          all[n] = joined(i, {some.at[0][n], some.at[1][n], some.at[2][n]}, all[n], other_ * part[n]);
      }
      for (std::size_t n = 0; n < some.count; ++n) to[begin + n] = first_ * all[n];
    }
  }
  /// Returns the normal of the part whose surface is nearest at p.
  Vec3d normal(const Vec3d& p) const override { return normal_to(parts_.size(), p) * first_; }
  Box3d bounds() const override {
    Box3d box = parts_[0]->bounds();
    if (op_ == Op::difference) return box;
    for (std::size_t i = 1; i < parts_.size(); ++i) {
      const Box3d b = parts_[i]->bounds();
      if (op_ == Op::unite)
        box.min = min(box.min, b.min), box.max = max(box.max, b.max);
      else
        box.min = max(box.min, b.min), box.max = min(box.max, b.max);
    }
    return box;
  }

 private:
  double side(std::size_t i, const Vec3d& p) const { return (i == 0 ? first_ : other_) * parts_[i]->distance(p); }
  Vec3d side_normal(std::size_t i, const Vec3d& p) const { return parts_[i]->normal(p) * (i == 0 ? first_ : other_); }

  /// Returns the distance from the intersection of the first `i` sides, which has the distance `d`,
  /// and of side `i`, which has `e`.
  double joined(std::size_t i, const Vec3d& p, double d, double e) const {
    const auto open = std::abs(d + e) <= same_ ? past_sheet(i, p, d) : std::nullopt;
    return open ? open->distance : std::max(d, e);
  }
  /// Returns the distance from the intersection of the first `count` sides.
  double distance_to(std::size_t count, const Vec3d& p) const {
    double d = side(0, p);
    for (std::size_t i = 1; i < count; ++i) d = joined(i, p, d, side(i, p));
    return d;
  }
  Vec3d normal_to(std::size_t count, const Vec3d& p) const {
    std::size_t felt = 0;
    std::optional<Felt> sheet;
    double d = side(0, p);
    for (std::size_t i = 1; i < count; ++i) {
      const double e = side(i, p);
      if (const auto open = std::abs(d + e) <= same_ ? past_sheet(i, p, d) : std::nullopt)
        d = open->distance, sheet = open, felt = i;
      else if (e > d)
        d = e, felt = i, sheet.reset();
    }
    return sheet ? sheet->normal : side_normal(felt, p);
  }

  /// Returns the distance past a sheet; nothing where there is no such sheet. Where the first `i`
  /// sides and side `i` end at one face, and lie on either side of it, their intersection is a
  /// sheet without thickness there, and no surface. The distance is then that from the rest of it,
  /// around the place of the sheet that is next to p. `d`: the distance from the first `i`.
  std::optional<Felt> past_sheet(std::size_t i, const Vec3d& p, double d) const {
    const Vec3d n = normal_to(i, p);
    constexpr double opposite = -0.99;
    if (dot(n, side_normal(i, p)) > opposite) return std::nullopt;
    const Vec3d foot = p - n * d;
    // A side is followed from the sheet into the other one, to where another face of it is nearer.
    const Edge before = edge(foot, -n, [&](const Vec3d& q) { return side(i, q); }),
               behind = edge(foot, n, [&](const Vec3d& q) { return distance_to(i, q); });
    const auto aside = [&](const Edge& at) { return std::hypot(d, at.distance); };
    const bool first = (d < 0 ? before.distance : aside(before)) <= (d < 0 ? aside(behind) : behind.distance);
    const Edge& at = first ? before : behind;
    const bool same_side = (d < 0) == first;
    const Vec3d q = foot + at.way;
    const Vec3d m = at.distance >= far_ ? Vec3d{} : first ? side_normal(i, q) : normal_to(i, q);
    if (same_side && length2(m) > 0) return Felt{at.distance, m};
    const Vec3d slope = n * d + m * at.distance;
    return Felt{same_side ? at.distance : aside(at), length2(slope) > 0 ? normalized(slope) : n};
  }

  /// Returns the edge of a sheet, as the side `distance` has it: its distance where the way from
  /// the sheet along `along` first comes nearer to another face of it; and the way to that place.
  template <class Distance>
  Edge edge(const Vec3d& foot, const Vec3d& along, const Distance& distance) const {
    const auto other_is_near = [&](double k) { return distance(foot + along * k) < k - 2 * same_; };
    if (!other_is_near(far_)) return {far_, along * far_};
    double low = 0, high = far_;
    for (int n = 0; n < 24; ++n) {
      const double k = 0.5 * (low + high);
      (other_is_near(k) ? high : low) = k;
    }
    return {std::max(distance(foot + along * high), 0.0), along * high};
  }

  double first_, other_;  ///< the signs with which parts are sides
  Op op_;
  std::vector<std::shared_ptr<const Region>> parts_;
  double same_, far_ = 0;  ///< m
};

}  // namespace

std::shared_ptr<const Region> combined(BooleanShape::Op op, std::vector<std::shared_ptr<const Region>> parts,
                                       double same) {
  return std::make_shared<Boolean>(op, std::move(parts), same);
}

}  // namespace dreampm
