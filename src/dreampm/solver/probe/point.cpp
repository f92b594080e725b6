// A material point: where it is now [m], and for materials that keep one their deformation gradient
// there. Weights over the particles around its start reproduce every affine field (moving least
// squares: Lancaster & Salkauskas 1981), so a body that turns or stretches as a whole carries it
// exactly, also if it starts on the surface.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "dreampm/base/error.h"
#include "dreampm/solver/probe/probe.h"

namespace dreampm {
namespace {

constexpr double reach_in_spacings = 2.5;

/// Weights of the seeds of `body` around `at`: their sum is 1 and their mean position is `at`.
std::map<std::uint32_t, double> weights_at(const Vec3d& at, const ProbeStart::Body& body, const ProbeStart& start,
                                           const std::string& name) {
  const double reach = reach_in_spacings * start.spacing;
  struct Near {
    std::uint32_t id;
    Vec3d r;
    double k;
  };
  std::vector<Near> near;
  Vec3d nearest{};
  double least = std::numeric_limits<double>::infinity(), sum = 0;
  Vec3d first{};
  Mat3d second;
  for (const ParticleSeed& n : start.seeds[body.set]) {
    if (n.id - body.first_id >= body.count) continue;
    const Vec3d r = n.position - at;
    const double d = length(r);
    if (d < least) least = d, nearest = n.position;
    if (d >= reach) continue;
    const double q = 1 - d * d / (reach * reach), k = q * q;
    near.push_back({n.id, r, k});
    sum += k;
    first += r * k;
    second = second + outer(r, r) * k;
  }
  // A point of the surface is half a spacing from the next particle, one of a corner 0.87.
  if (near.empty() || least > 1.5 * start.spacing)
    fail_input(
        "probe {}: at [{:.6g}, {:.6g}, {:.6g}] the body {} has no matter; the nearest is at [{:.6g}, {:.6g}, {:.6g}]",
        name, at.x, at.y, at.z, body.name, nearest.x, nearest.y, nearest.z);
  const double size = trace(second) / 3, det = determinant(second);
  Vec3d slope{};  // stays zero for matter one particle thin: the plain mean
  if (det > 1e-6 * size * size * size) slope = transpose(cofactor(second)) * first * (-1 / det);
  const double level = 1 / (sum + dot(slope, first));
  std::map<std::uint32_t, double> weights;
  for (const Near& n : near) weights[n.id] = n.k * level * (1 + dot(slope, n.r));
  return weights;
}

template <class R>
class Point final : public Probe<R> {
 public:
  Point(const PointProbe& spec, const std::string& name, const ProbeStart& start) {
    const ProbeStart::Body& body = start.bodies.at(model::index_of(start.bodies, spec.body));
    set_ = body.set;
    weights_ = weights_at(spec.at, body, start, name);
    gradient_ = find_column(start.world.sets[set_].material, "f_00");
  }

  std::vector<std::string> columns() const override {
    std::vector<std::string> names{"x", "y", "z"};
    if (gradient_)
      for (int i = 0; i < 9; ++i) names.push_back(fmt::format("f_{}{}", i / 3, i % 3));
    return names;
  }
  MatterFields fields() const override {
    const MatterFields place = MatterFields::id | MatterFields::position;
    return gradient_ ? place | MatterFields::state : place;
  }

  std::optional<std::vector<double>> sample(const ProbeContext<R>& now) override {
    const ParticleSetView<R> particles = now.particles(set_);
    std::vector<double> row(gradient_ ? 12 : 3, 0);
    std::size_t found = 0;
    Vec3d first{};  // the weights' sum is 1: places may be counted from any of them
    particles.for_each([&](std::size_t p, const Vec3d& x) {
      const auto w = weights_.find(particles.id(p));
      if (w == weights_.end()) return;
      if (found++ == 0) first = x;
      const Vec3d way = nearest_copy(now.world, x - first);
      for (int a = 0; a < 3; ++a) row[static_cast<std::size_t>(a)] += w->second * way[a];
      for (std::size_t c = 3; c < row.size(); ++c)
        row[c] += w->second * static_cast<double>(particles.column(*gradient_ + c - 3)[p]);
    });
    for (int a = 0; a < 3; ++a) row[static_cast<std::size_t>(a)] += first[a];
    // Some of its matter has left through an open wall.
    if (found < weights_.size()) std::fill(row.begin(), row.end(), std::numeric_limits<double>::quiet_NaN());
    return row;
  }

 private:
  std::size_t set_ = 0;
  std::map<std::uint32_t, double> weights_;
  std::optional<std::size_t> gradient_;
};

}  // namespace

template <class R>
std::unique_ptr<Probe<R>> make_one(const PointProbe& spec, const std::string& name, const ProbeStart& start) {
  return std::make_unique<Point<R>>(spec, name, start);
}
template std::unique_ptr<Probe<float>> make_one(const PointProbe&, const std::string&, const ProbeStart&);
template std::unique_ptr<Probe<double>> make_one(const PointProbe&, const std::string&, const ProbeStart&);

}  // namespace dreampm
