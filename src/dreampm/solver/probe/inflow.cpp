// The inflow of an emitter or outflow of a sink: rate [m^3/s] as the mean since the row before,
// total [m^3] since the start, as volume at rest, and the count of particles.
#include <algorithm>

#include "dreampm/solver/probe/probe.h"

namespace dreampm {
namespace {

template <class R>
class Inflow final : public Probe<R> {
 public:
  Inflow(const InflowProbe& spec, const ProbeStart& start) {
    const auto is_it = [&](const auto& one) { return one.name == spec.on; };
    is_emitter_ = std::any_of(start.world.emitters.begin(), start.world.emitters.end(), is_it);
    number_ =
        is_emitter_ ? model::index_of(start.world.emitters, spec.on) : model::index_of(start.world.sinks, spec.on);
  }

  std::vector<std::string> columns() const override { return {"rate", "total", "count"}; }
  MatterFields fields() const override { return MatterFields::none; }

  std::optional<std::vector<double>> sample(const ProbeContext<R>& now) override {
    const World<R>& world = now.world;
    // All sets of a scene have particles of one size.
    const double each = world.sets.at(0).rest_volume;
    const auto count =
        static_cast<double>(is_emitter_ ? world.emitters.at(number_).born : world.sinks.at(number_).taken);
    const double dt = world.time - time_, passed = (count - count_) * each;
    time_ = world.time, count_ = count;
    if (!(dt > 0)) return std::nullopt;
    return std::vector<double>{passed / dt, count * each, count};
  }

  std::vector<double> memory() const override { return {time_, count_}; }
  void restore(const std::vector<double>& m) override { time_ = m.at(0), count_ = m.at(1); }

 private:
  bool is_emitter_ = false;
  std::size_t number_ = 0;
  double time_ = 0, count_ = 0;
};

}  // namespace

template <class R>
std::unique_ptr<Probe<R>> make_one(const InflowProbe& spec, const std::string&, const ProbeStart& start) {
  return std::make_unique<Inflow<R>>(spec, start);
}
template std::unique_ptr<Probe<float>> make_one(const InflowProbe&, const std::string&, const ProbeStart&);
template std::unique_ptr<Probe<double>> make_one(const InflowProbe&, const std::string&, const ProbeStart&);

}  // namespace dreampm
