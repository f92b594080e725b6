// What passes a plane along its normal: total [m^3] since the start, rate [m^3/s] as the mean since the row before.
// Volume at rest, so that squeezing moves nothing. A particle counts by the part of its cube that has passed, so that a
// block in even motion gives an even rate.
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
    for (const auto& set : start.newborns)
      for (const Newborn& n : set) seen(n.id) = dot(n.position - point_, normal_);
  }

  std::vector<std::string> columns() const override { return {"rate", "total"}; }

  std::optional<std::vector<double>> sample(const Sight<R>& now) override {
    double passed = 0;
    for (const auto& set : now.world.sets) {
      const double h = edge_of(set);
      const auto share = [&](double s) { return std::clamp(0.5 + s / h, 0.0, 1.0); };
      for_particles(now.world, set, [&](std::size_t p, const Vec3d& x) {
        const double s = dot(x - point_, normal_);
        double& before = seen(set.id[p]);
        if (!std::isnan(before)) passed += (share(s) - share(before)) * set.rest_volume;
        before = s;
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
    all.insert(all.end(), distance_.begin(), distance_.end());
    return all;
  }
  void remember(const std::vector<double>& all) override {
    total_ = all.at(0);
    time_ = all.at(1);
    distance_.assign(all.begin() + 2, all.end());
  }

 private:
  /// The distance [m] along the normal at which the particle was last seen.
  double& seen(std::uint32_t id) {
    if (distance_.size() <= id) distance_.resize(id + std::size_t(1), unseen);
    return distance_[id];
  }

  Vec3d point_, normal_;
  double total_ = 0, time_ = 0;
  std::vector<double> distance_;
};

}  // namespace

template <class R>
std::unique_ptr<Probe<R>> make_one(const FluxProbe& spec, const std::string&, const ProbeStart& start) {
  return std::make_unique<Flux<R>>(spec, start);
}
template std::unique_ptr<Probe<float>> make_one(const FluxProbe&, const std::string&, const ProbeStart&);
template std::unique_ptr<Probe<double>> make_one(const FluxProbe&, const std::string&, const ProbeStart&);

}  // namespace dreampm
