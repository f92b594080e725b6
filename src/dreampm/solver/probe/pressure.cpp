// The pressure [Pa] at a point of a wall: -n sigma n, the mean over the volume of matter within the
// radius, on the side that the normal points to. For a liquid at rest it is its pressure; where
// nothing touches the wall it is 0. Viscous stress is not in it: it is not stored with a particle.
// By the projection it is that of the cells, over the liquid there.
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
    if (now.world.settings.solver == SolverKind::projection) return std::vector<double>{of_cells(now.world)};
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
  /// The mean over places in cells of liquid.
  double of_cells(const World<R>& world) const {
    constexpr int along = 5;  // of the radius
    const CellPressure<R> pressure(world);
    const double apart = std::sqrt(radius2_) / along;
    double sum = 0;
    int places = 0;
    for (int i = -along; i < along; ++i)
      for (int j = -along; j < along; ++j)
        for (int k = -along; k < along; ++k) {
          const Vec3d way = Vec3d{i + 0.5, j + 0.5, k + 0.5} * apart;
          if (length2(way) > radius2_ || dot(way, normal_) < 0) continue;
          const Vec3d cell = (at_ + way - world.origin) / world.dx;
          Vec3i in;
          for (int a = 0; a < 3; ++a) in[a] = world.low[a] + static_cast<std::int32_t>(std::floor(cell[a]));
          if (pressure.of_cell(in) != 0) sum += pressure.at(at_ + way), ++places;
        }
    return places > 0 ? sum / places : 0;
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
