#include "dreampm/backend/gpu/device_fields.h"

#include "dreampm/state/force_fields.h"

namespace dreampm::gpu {

void DeviceFields::apply(const VisitInput& in, const World<float>& world, double dt) {
  std::vector<FieldStep> steps;
  for (const auto& one : FieldSteps<float>(world, dt)) steps.emplace_back(one.step, one.box);
  fields_.upload(steps);
  if (steps.empty()) return;
  given_.resize(world.grid.blocks.size());
  for (std::size_t f = 0; f < 2; ++f) impulses_[f].resize(world.grid.field(f).size());
  launch(*device_, ApplyFields{in, input()}, given_.size());
}

FieldInput DeviceFields::input() const {
  return {fields_.data(),
          static_cast<std::int32_t>(fields_.size()),
          {impulses_[0].data(), impulses_[1].data()},
          given_.data()};
}

void DeviceFields::find_work(const VisitInput& in) {
  if (fields_.size() > 0) launch(*device_, FieldWork{in, input()}, given_.size());
}

double DeviceFields::work(const VisitInput& in) {
  if (fields_.size() == 0) return 0;
  find_work(in);
  std::vector<SourceTerms> home(given_.size(), SourceTerms::none());
  given_.download(home);
  double work = 0;
  for (const SourceTerms& one : home) work += one.work;
  return work;
}

}  // namespace dreampm::gpu
