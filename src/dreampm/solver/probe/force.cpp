// The force [N] of the matter on a wall or collider and its torque [N m] about the scene's origin:
// means since the row before, from the impulses that every step gave to the nodes there.
#include "dreampm/solver/probe/probe.h"

namespace dreampm {
namespace {

template <class R>
class Force final : public Probe<R> {
 public:
  Force(const ForceProbe& spec, const ProbeStart& start)
      : wall_(side_called(spec.on)), collider_(wall_ ? 0 : model::index_of(start.world.colliders, spec.on)) {}

  std::vector<std::string> columns() const override { return {"fx", "fy", "fz", "tx", "ty", "tz"}; }
  MatterFields fields() const override { return MatterFields::none; }

  void accumulate(const StepSums& step) override {
    const ImpulseSum& p = wall_ ? step.grid.walls.at(index(*wall_)) : step.grid.colliders.at(collider_);
    // The matter got p; the wall gets the opposite.
    impulse_ -= p.impulse;
    angular_ -= p.angular;
    duration_ += step.dt;
  }

  std::optional<std::vector<double>> sample(const ProbeContext<R>&) override {
    if (!(duration_ > 0)) return std::nullopt;
    const Vec3d f = impulse_ / duration_, t = angular_ / duration_;
    impulse_ = angular_ = {};
    duration_ = 0;
    return std::vector<double>{f.x, f.y, f.z, t.x, t.y, t.z};
  }

  std::vector<double> memory() const override {
    return {impulse_.x, impulse_.y, impulse_.z, angular_.x, angular_.y, angular_.z, duration_};
  }
  void restore(const std::vector<double>& m) override {
    impulse_ = {m.at(0), m.at(1), m.at(2)};
    angular_ = {m.at(3), m.at(4), m.at(5)};
    duration_ = m.at(6);
  }

 private:
  std::optional<Side> wall_;
  std::size_t collider_;
  Vec3d impulse_{}, angular_{};
  double duration_ = 0;
};

}  // namespace

template <class R>
std::unique_ptr<Probe<R>> make_one(const ForceProbe& spec, const std::string&, const ProbeStart& start) {
  return std::make_unique<Force<R>>(spec, start);
}
template std::unique_ptr<Probe<float>> make_one(const ForceProbe&, const std::string&, const ProbeStart&);
template std::unique_ptr<Probe<double>> make_one(const ForceProbe&, const std::string&, const ProbeStart&);

}  // namespace dreampm
