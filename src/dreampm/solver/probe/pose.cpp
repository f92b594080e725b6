// The pose and motion of a collider or rigid body: for a rigid body the center of mass, for another
// collider the point that it turns about; the rotation of the shape as the scene gives it, as a
// quaternion; velocity [m/s] of that point, and spin [rad/s].
#include "dreampm/solver/probe/probe.h"

namespace dreampm {
namespace {

template <class R>
class PoseOf final : public Probe<R> {
 public:
  PoseOf(const PoseProbe& spec, const ProbeStart& start) : collider_(model::index_of(start.world.colliders, spec.on)) {}

  std::vector<std::string> columns() const override {
    return {"x", "y", "z", "qw", "qx", "qy", "qz", "vx", "vy", "vz", "wx", "wy", "wz"};
  }
  MatterFields fields() const override { return MatterFields::none; }
  std::optional<std::vector<double>> sample(const ProbeContext<R>& now) override {
    const Collider& c = now.world.colliders.at(collider_);
    const auto& [v, w, x] = c.twist;
    const Quaternion& q = c.pose.rotation;
    return std::vector<double>{x.x, x.y, x.z, q.w, q.x, q.y, q.z, v.x, v.y, v.z, w.x, w.y, w.z};
  }

 private:
  std::size_t collider_;
};

}  // namespace

template <class R>
std::unique_ptr<Probe<R>> make_one(const PoseProbe& spec, const std::string&, const ProbeStart& start) {
  return std::make_unique<PoseOf<R>>(spec, start);
}
template std::unique_ptr<Probe<float>> make_one(const PoseProbe&, const std::string&, const ProbeStart&);
template std::unique_ptr<Probe<double>> make_one(const PoseProbe&, const std::string&, const ProbeStart&);

}  // namespace dreampm
