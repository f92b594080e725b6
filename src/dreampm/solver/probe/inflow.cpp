// What comes in by an emitter or goes out by a sink: rate [m^3/s] as the mean since the row before,
// total [m^3] since the start, as volume at rest, and the count of particles.
#include "dreampm/solver/probe/probe.h"

namespace dreampm {
namespace {

template <class R>
class Inflow final : public Probe<R> {
 public:
  explicit Inflow(const InflowProbe& spec) : emitter_(spec.emitter), sink_(spec.sink) {}

  std::vector<std::string> columns() const override { return {"rate", "total", "count"}; }
  MatterFields fields() const override { return MatterFields::none; }

  std::optional<std::vector<double>> sample(const ProbeContext<R>& now) override {
    const World<R>& world = now.world;
    // All sets of a scene have particles of one size.
    const double each = world.sets.at(0).rest_volume;
    const auto count = static_cast<double>(emitter_ >= 0 ? world.emitters.at(static_cast<std::size_t>(emitter_)).born
                                                         : world.sinks.at(static_cast<std::size_t>(sink_)).taken);
    const double dt = world.time - time_, passed = (count - count_) * each;
    time_ = world.time, count_ = count;
    if (!(dt > 0)) return std::nullopt;
    return std::vector<double>{passed / dt, count * each, count};
  }

  std::vector<double> memory() const override { return {time_, count_}; }
  void restore(const std::vector<double>& m) override { time_ = m.at(0), count_ = m.at(1); }

 private:
  int emitter_, sink_;
  double time_ = 0, count_ = 0;
};

}  // namespace

template <class R>
std::unique_ptr<Probe<R>> make_one(const InflowProbe& spec, const std::string&, const ProbeStart&) {
  return std::make_unique<Inflow<R>>(spec);
}
template std::unique_ptr<Probe<float>> make_one(const InflowProbe&, const std::string&, const ProbeStart&);
template std::unique_ptr<Probe<double>> make_one(const InflowProbe&, const std::string&, const ProbeStart&);

}  // namespace dreampm
