#include "dreampm/setup/thin_colliders.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "dreampm/base/parallel.h"
#include "dreampm/setup/round_down.h"

namespace dreampm {
namespace {

constexpr double covered = 0.1;    // cells: a gap that narrow lets no matter in
constexpr double step = 1.0 / 16;  // cells, the least along a line
// Each place of a flat wall is seen along the axis nearest to its normal, whose part of that is
// 0.577 or more.
constexpr double steep = 0.55;
// Two sides of a wall look away from each other; those of an edge of 60 degrees or more are none.
constexpr double opposite = -0.5;
constexpr int least_lines = 8;      // across a small collider
constexpr double most_steps = 6e6;  // of all lines together
constexpr double slack = 0.97;      // the distance from a mesh is sampled, and errs by that

/// A piece of a line inside of the collider, thin and open on both sides.
struct Piece {
  double middle;     ///< m along the line
  double thickness;  ///< m
};

class Search {
 public:
  Search(const World<double>& world, std::size_t c)
      : world_(world), shape_(world.colliders[c]), dx_(world.dx), least_(thinnest_wall(world.settings.solver)) {
    const Vec3d low = world.origin, high = world.node_position(world.high);
    const Box3d own = shape_.bounds();
    const Vec3d length = high - low;
    for (int a = 0; a < 3; ++a) {
      for (const int end : {0, 1}) {
        const auto side = static_cast<std::size_t>(2 * a + end);
        closed_[side] = !world.periodic[static_cast<std::size_t>(a)] && world.walls[side].type != WallType::open;
      }
      // Beyond an open side matter goes on for a while.
      const auto s = static_cast<std::size_t>(2 * a);
      space_.min[a] = closed_[s] ? low[a] : low[a] - length[a];
      space_.max[a] = closed_[s + 1] ? high[a] : high[a] + length[a];
      box_.min[a] = std::max(own.min[a], space_.min[a]), box_.max[a] = std::min(own.max[a], space_.max[a]);
    }
    for (std::size_t k = 0; k < world.colliders.size(); ++k) {
      if (k == c) continue;
      const Box3d b = world.colliders[k].bounds();
      bool near = true;
      for (int a = 0; a < 3; ++a) near = near && b.min[a] < box_.max[a] + dx_ && b.max[a] > box_.min[a] - dx_;
      if (near) others_.push_back(k);
    }
  }

  std::optional<ThinPlace> thinnest() const {
    if (box_.max.x < box_.min.x || box_.max.y < box_.min.y || box_.max.z < box_.min.z) return std::nullopt;
    const Vec3d size = box_.size();
    Vec3d apart;
    double steps = 0;
    for (int a = 0; a < 3; ++a) apart[a] = std::max(std::min(0.5 * dx_, size[a] / least_lines), 1e-3 * dx_);
    for (int a = 0; a < 3; ++a) steps += lines(a, apart) * (size[a] / dx_ + 30);
    if (steps > most_steps) apart = apart * std::sqrt(steps / most_steps);
    std::optional<ThinPlace> least;
    for (int a = 0; a < 3; ++a)
      if (const auto found = along(a, apart); found && (!least || found->thickness < least->thickness)) least = found;
    return least;
  }

 private:
  double lines(int axis, const Vec3d& apart) const {
    const Vec3d size = box_.size();
    double n = 1;
    for (int a = 0; a < 3; ++a)
      if (a != axis) n *= std::max(1.0, size[a] / apart[a]);
    return n;
  }

  std::optional<ThinPlace> along(int axis, const Vec3d& apart) const {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const Vec3d size = box_.size();
    const auto nu = std::max<std::size_t>(1, std::size_t(std::ceil(size[u] / apart[u] - 1e-9))),
               nv = std::max<std::size_t>(1, std::size_t(std::ceil(size[v] / apart[v] - 1e-9)));
    const double du = size[u] / double(nu), dv = size[v] / double(nv);
    const auto start = [&](std::size_t l) {
      Vec3d p;
      p[u] = box_.min[u] + (double(l / nv) + 0.5) * du;
      p[v] = box_.min[v] + (double(l % nv) + 0.5) * dv;
      return p;
    };
    std::vector<std::vector<Piece>> found(nu * nv);
    parallel_for(found.size(), 16, [&](std::size_t l) { found[l] = pieces(start(l), axis); });
    // One line may only graze an edge. Around the middle of a thin place more than a cell wide all
    // lines agree; the wall may rise by more than the lines are apart.
    const double rise = 2.5 * std::max(du, dv) + 0.5 * dx_;
    std::optional<ThinPlace> least;
    for (std::size_t i = 1; i + 1 < nu; ++i)
      for (std::size_t j = 1; j + 1 < nv; ++j)
        for (const Piece& p : found[i * nv + j]) {
          if (least && p.thickness >= least->thickness) continue;
          bool agree = true;
          for (std::size_t k = 0; k < 9 && agree; ++k) {
            const auto& beside = found[(i + k / 3 - 1) * nv + j + k % 3 - 1];
            agree = std::any_of(beside.begin(), beside.end(),
                                [&](const Piece& q) { return std::abs(q.middle - p.middle) < rise; });
          }
          if (!agree) continue;
          least = ThinPlace{p.thickness, start(i * nv + j)};
          least->at[axis] = p.middle;
        }
    return least;
  }

  /// The thin pieces of the line through `p`.
  std::vector<Piece> pieces(Vec3d p, int axis) const {
    std::vector<Piece> out;
    const auto at = [&](double t) {
      p[axis] = t;
      return p;
    };
    const auto distance = [&](double t) { return shape_.distance(at(t)); };
    const double end = box_.max[axis] + 2 * step * dx_, least = step * dx_;
    double t = box_.min[axis] - least, d = distance(t), enter = t;
    while (t < end) {
      const double next = t + std::max(std::abs(d), least);
      const double e = distance(next);
      if (d > 0 && e > 0) {
        // A distance changes by no more than the way; between two that are less in all a very thin
        // wall may stand.
        if (d + e < next - t) {
          const double middle = lowest(distance, t, next);
          if (distance(middle) < 0) add(out, at, axis, crossing(distance, middle, t), crossing(distance, middle, next));
        }
      } else if (d > 0) {
        enter = crossing(distance, next, t);
      } else if (e > 0) {
        add(out, at, axis, enter, crossing(distance, t, next));
      }
      t = next, d = e;
    }
    return out;
  }

  template <class Distance>
  static double lowest(const Distance& distance, double from, double to) {
    for (int i = 0; i < 40; ++i) {
      const double a = from + (to - from) / 3, b = to - (to - from) / 3;
      if (distance(a) < distance(b))
        to = b;
      else
        from = a;
    }
    return 0.5 * (from + to);
  }
  template <class Distance>
  static double crossing(const Distance& distance, double inside, double outside) {
    for (int i = 0; i < 30; ++i) {
      const double t = 0.5 * (inside + outside);
      (distance(t) < 0 ? inside : outside) = t;
    }
    return 0.5 * (inside + outside);
  }

  template <class At>
  void add(std::vector<Piece>& out, const At& at, int axis, double from, double to) const {
    // A piece that is thin along the line only because it is oblique is none.
    if (to - from > least_ * dx_ / steep) return;
    const Vec3d n = shape_.normal(at(from)), m = shape_.normal(at(to));
    if (std::abs(n[axis]) < steep || std::abs(m[axis]) < steep || dot(n, m) > opposite) return;
    const double thickness = through(at(from), n);
    if (!(thickness < slack * least_ * dx_)) return;
    if (is_covered(at(from) + n * (covered * dx_)) || is_covered(at(to) + m * (covered * dx_))) return;
    out.push_back({0.5 * (from + to), thickness});
  }

  /// Returns the distance from a place on the surface straight to the other side; at most about a
  /// cell.
  double through(const Vec3d& p, const Vec3d& normal) const {
    const auto distance = [&](double t) { return shape_.distance(p - normal * t); };
    const double least = 1e-3 * dx_;
    double t = least;
    while (t < dx_) {
      const double d = distance(t);
      if (d > 0) return crossing(distance, t - least, t);
      t += std::max(-d, least);
    }
    return t;
  }

  /// True if a closed wall or another collider covers the place.
  bool is_covered(const Vec3d& p) const {
    for (int a = 0; a < 3; ++a) {
      const auto side = static_cast<std::size_t>(2 * a);
      if ((closed_[side] && p[a] < space_.min[a]) || (closed_[side + 1] && p[a] > space_.max[a])) return true;
    }
    return std::any_of(others_.begin(), others_.end(),
                       [&](std::size_t k) { return world_.colliders[k].distance(p) < 0; });
  }

  const World<double>& world_;
  const Collider& shape_;
  double dx_;
  double least_;  ///< cells
  std::array<bool, 6> closed_{};
  Box3d space_, box_;
  std::vector<std::size_t> others_;
};

}  // namespace

std::optional<ThinPlace> thin_place(const World<double>& world, std::size_t c) { return Search(world, c).thinnest(); }

std::vector<std::string> thin_collider_warnings(const World<double>& world, const model::Space& space) {
  std::vector<std::string> lines;
  for (std::size_t c = 0; c < world.colliders.size(); ++c)
    if (const auto thin = thin_place(world, c)) {
      const double least = thinnest_wall(world.settings.solver);
      const double enough = two_digits(thin->thickness / least / std::cbrt(space.particles_per_cell));
      lines.push_back(
          fmt::format("collider {} is {:.2g} m thick at ({:.4g}, {:.4g}, {:.4g}), less than {} cell of {:.4g} m: "
                      "matter may pass through; make it thicker, or space.spacing {:.2g} m or less",
                      world.colliders[c].name, thin->thickness, thin->at.x, thin->at.y, thin->at.z,
                      least < 1 ? "half a" : "a", world.dx, enough));
    }
  return lines;
}

}  // namespace dreampm
