// The matter within a shape: volume [m^3], mass [kg], center of mass [m], mean J, mean speed [m/s],
// of the particles whose centers are inside. NaN for the means of nothing.
#include <cmath>
#include <limits>

#include "dreampm/solver/probe/probe.h"

namespace dreampm {
namespace {

template <class R>
class InRegion final : public Probe<R> {
 public:
  explicit InRegion(std::shared_ptr<const Region> region) : region_(std::move(region)), bounds_(region_->bounds()) {}

  std::vector<std::string> columns() const override { return {"volume", "mass", "x", "y", "z", "j", "speed"}; }
  MatterFields fields() const override { return MatterFields::position | MatterFields::motion; }

  std::optional<std::vector<double>> sample(const ProbeContext<R>& now) override {
    double volume = 0, rest = 0, mass = 0, speed = 0;
    Vec3d center{};
    for (std::size_t s = 0; s < now.world.sets.size(); ++s) {
      const auto& set = now.world.sets[s];
      const auto& m = now.motion.sets[s];
      now.particles(s).for_each([&](std::size_t p, const Vec3d& x) {
        if (!bounds_.contains(x) || region_->distance(x) > 0) return;
        volume += set.rest_volume * static_cast<double>(m.volume_ratio[p]);
        rest += set.rest_volume;
        mass += set.mass;
        center += x * set.mass;
        speed += length(static_cast<Vec3d>(m.velocity[p])) * set.mass;
      });
    }
    const double per_mass = mass > 0 ? 1 / mass : std::numeric_limits<double>::quiet_NaN();
    center = center * per_mass;
    return std::vector<double>{volume, mass, center.x, center.y, center.z, volume / rest, speed * per_mass};
  }

 private:
  std::shared_ptr<const Region> region_;
  Box3d bounds_;
};

}  // namespace

template <class R>
std::unique_ptr<Probe<R>> make_one(const RegionProbe& spec, const std::string&, const ProbeStart& start) {
  return std::make_unique<InRegion<R>>(make_region(spec.shape, start.spacing, start.meshes));
}
template std::unique_ptr<Probe<float>> make_one(const RegionProbe&, const std::string&, const ProbeStart&);
template std::unique_ptr<Probe<double>> make_one(const RegionProbe&, const std::string&, const ProbeStart&);

}  // namespace dreampm
