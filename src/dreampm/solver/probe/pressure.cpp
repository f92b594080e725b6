// The pressure [Pa] at a point of a wall: -n sigma n, the mean over the volume of matter within the
// radius, on the side that the normal points to. For a liquid at rest it is its pressure; where
// nothing touches the wall it is 0. Viscous stress is not in it: it is not stored with a particle.
#include <cmath>

#include "dreampm/physics/materials.h"
#include "dreampm/solver/probe/probe.h"

namespace dreampm {
namespace {

template <class R>
class Pressure final : public Probe<R> {
 public:
  explicit Pressure(const PressureProbe& spec)
      : at_(spec.at), normal_(normalized(spec.normal)), radius2_(spec.radius * spec.radius) {}

  std::vector<std::string> columns() const override { return {"pressure"}; }
  MatterFields fields() const override { return MatterFields::position | MatterFields::state | MatterFields::motion; }

  std::optional<std::vector<double>> sample(const ProbeContext<R>& now) override {
    double force = 0, volume = 0;
    for (std::size_t s = 0; s < now.world.sets.size(); ++s) {
      const auto& set = now.world.sets[s];
      const double behind = -0.5 * edge_of(set);  // matter pressed onto the wall still counts
      Materials::with(set.material, [&]<class M>() {
        const auto law = M::template Law<R>::from(set.values);
        const ParticleSetView<R> particles = now.particles(s);
        particles.for_each([&](std::size_t p, const Vec3d& x) {
          const Vec3d r = nearest_copy(now.world, x - at_);
          if (length2(r) > radius2_ || dot(r, normal_) < behind) return;
          const Vec3<R> n = static_cast<Vec3<R>>(normal_);
          // sigma J V0 = tau V0
          force -= static_cast<double>(dot(n, law.respond(particles.template state<M>(p)).tau * n)) * set.rest_volume;
          volume += static_cast<double>(now.motion.sets[s].volume_ratio[p]) * set.rest_volume;
        });
      });
    }
    return std::vector<double>{volume > 0 ? force / volume : 0};
  }

 private:
  Vec3d at_, normal_;
  double radius2_;
};

}  // namespace

template <class R>
std::unique_ptr<Probe<R>> make_one(const PressureProbe& spec, const std::string&, const ProbeStart&) {
  return std::make_unique<Pressure<R>>(spec);
}
template std::unique_ptr<Probe<float>> make_one(const PressureProbe&, const std::string&, const ProbeStart&);
template std::unique_ptr<Probe<double>> make_one(const PressureProbe&, const std::string&, const ProbeStart&);

}  // namespace dreampm
