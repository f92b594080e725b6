// The flux through a plane along its normal: total [m^3] since the start, rate [m^3/s] as the mean
// since the row before. Volume at rest, so that squeezing moves nothing. A particle counts by the
// part of its cube that has passed, so that a block in even motion gives an even rate. On periodic
// axes it counts each time round: between two rows it must move less than half a period.
#include <algorithm>
#include <cmath>
#include <limits>

#include "dreampm/solver/probe/probe.h"

namespace dreampm {
namespace {

constexpr double unseen = std::numeric_limits<double>::quiet_NaN();

template <class R>
class Flux final : public Probe<R> {
 public:
  Flux(const FluxProbe& spec, const ProbeStart& start) : point_(spec.point), normal_(normalized(spec.normal)) {
    for (const auto& set : start.seeds)
      for (const ParticleSeed& n : set) last_of(n.id) = n.position;
  }

  std::vector<std::string> columns() const override { return {"rate", "total"}; }
  MatterFields fields() const override { return MatterFields::id | MatterFields::position; }

  std::optional<std::vector<double>> sample(const ProbeContext<R>& now) override {
    double passed = 0;
    for (std::size_t s = 0; s < now.world.sets.size(); ++s) {
      const auto& set = now.world.sets[s];
      const ParticleSetView<R> particles = now.particles(s);
      const double h = edge_of(set);
      const auto share = [&](double past) { return std::clamp(0.5 + past / h, 0.0, 1.0); };
      particles.for_each([&](std::size_t p, const Vec3d& x) {
        Vec3d& before = last_of(particles.id(p));
        if (!std::isnan(before.x)) {
          // The copy of the plane that is nearest to the middle of the path.
          const Vec3d way = nearest_copy(now.world, x - before);
          const double middle = dot(nearest_copy(now.world, before + way * 0.5 - point_), normal_);
          const double half = 0.5 * dot(way, normal_);
          passed += (share(middle + half) - share(middle - half)) * set.rest_volume;
        }
        before = x;
      });
    }
    const double dt = now.world.time - time_;
    total_ += passed;
    time_ = now.world.time;
    if (!(dt > 0)) return std::nullopt;
    return std::vector<double>{passed / dt, total_};
  }

  std::vector<double> memory() const override {
    std::vector<double> all{total_, time_};
    for (const Vec3d& x : last_) all.insert(all.end(), {x.x, x.y, x.z});
    return all;
  }
  void restore(const std::vector<double>& all) override {
    total_ = all.at(0);
    time_ = all.at(1);
    last_.resize((all.size() - 2) / 3);
    for (std::size_t i = 0; i < last_.size(); ++i) last_[i] = {all[3 * i + 2], all[3 * i + 3], all[3 * i + 4]};
  }

 private:
  /// Returns the last seen place of the particle [m].
  Vec3d& last_of(std::uint32_t id) {
    if (last_.size() <= id) last_.resize(id + std::size_t(1), {unseen, unseen, unseen});
    return last_[id];
  }

  Vec3d point_, normal_;
  double total_ = 0, time_ = 0;
  std::vector<Vec3d> last_;
};

}  // namespace

template <class R>
std::unique_ptr<Probe<R>> make_one(const FluxProbe& spec, const std::string&, const ProbeStart& start) {
  return std::make_unique<Flux<R>>(spec, start);
}
template std::unique_ptr<Probe<float>> make_one(const FluxProbe&, const std::string&, const ProbeStart&);
template std::unique_ptr<Probe<double>> make_one(const FluxProbe&, const std::string&, const ProbeStart&);

}  // namespace dreampm
