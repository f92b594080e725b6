// The pressure [Pa] at a point of a wall: -n sigma n, the mean over the volume of matter within the
// radius, on the side that the normal points to. For a liquid at rest it is its pressure; where
// nothing touches the wall it is 0. Viscous stress is not in it: it is not stored with a particle.
// By the projection it is that of the cells, at the particles.
#include <cmath>

#include "dreampm/physics/materials.h"
#include "dreampm/solver/probe/probe.h"
#include "dreampm/state/cell_pressure.h"

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
    if (now.world.settings.solver == SolverKind::projection) return std::vector<double>{of_cells(now)};
    double force = 0, volume = 0;
    for (std::size_t s = 0; s < now.world.sets.size(); ++s) {
      const auto& set = now.world.sets[s];
      const double behind = behind_of(set);
      Materials::with(set.material, [&]<class M>() {
        const auto law = M::template Law<R>::from(set.values);
        const ParticleSetView<R> particles = now.particles(s);
        particles.for_each([&](std::size_t p, const Vec3d& x) {
          const Vec3d r = nearest_copy(now.world, x - at_);
          if (!counts(r, behind)) return;
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
  /// Matter that is pressed onto the wall still counts.
  static double behind_of(const ParticleSet<R>& set) { return -0.5 * edge_of(set); }
  bool counts(const Vec3d& way, double behind) const {
    return !(length2(way) > radius2_ || dot(way, normal_) < behind);
  }
  double of_cells(const ProbeContext<R>& now) const {
    const CellPressure<R> pressure(now.world);
    double force = 0, volume = 0;
    for (std::size_t s = 0; s < now.world.sets.size(); ++s) {
      const auto& set = now.world.sets[s];
      const double behind = behind_of(set);
      now.particles(s).for_each([&](std::size_t, const Vec3d& x) {
        if (!counts(nearest_copy(now.world, x - at_), behind)) return;
        force += pressure.at(x) * set.rest_volume, volume += set.rest_volume;
      });
    }
    return volume > 0 ? force / volume : 0;
  }

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
