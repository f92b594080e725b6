// The mean velocity [m/s] of the matter within a radius, by mass. NaN where there is none.
#include <cmath>
#include <limits>

#include "dreampm/solver/probe/probe.h"

namespace dreampm {
namespace {

template <class R>
class Velocity final : public Probe<R> {
 public:
  explicit Velocity(const VelocityProbe& spec) : at_(spec.at), radius2_(spec.radius * spec.radius) {}

  std::vector<std::string> columns() const override { return {"vx", "vy", "vz"}; }
  MatterFields fields() const override { return MatterFields::position | MatterFields::motion; }

  std::optional<std::vector<double>> sample(const ProbeContext<R>& now) override {
    Vec3d momentum{};
    double mass = 0;
    for (std::size_t s = 0; s < now.world.sets.size(); ++s) {
      const auto& set = now.world.sets[s];
      now.particles(s).for_each([&](std::size_t p, const Vec3d& x) {
        if (length2(nearest_copy(now.world, x - at_)) > radius2_) return;
        momentum += static_cast<Vec3d>(now.motion.sets[s].velocity[p]) * set.mass;
        mass += set.mass;
      });
    }
    if (mass == 0) return std::vector<double>(3, std::numeric_limits<double>::quiet_NaN());
    const Vec3d v = momentum / mass;
    return std::vector<double>{v.x, v.y, v.z};
  }

 private:
  Vec3d at_;
  double radius2_;
};

}  // namespace

template <class R>
std::unique_ptr<Probe<R>> make_one(const VelocityProbe& spec, const std::string&, const ProbeStart&) {
  return std::make_unique<Velocity<R>>(spec);
}
template std::unique_ptr<Probe<float>> make_one(const VelocityProbe&, const std::string&, const ProbeStart&);
template std::unique_ptr<Probe<double>> make_one(const VelocityProbe&, const std::string&, const ProbeStart&);

}  // namespace dreampm
