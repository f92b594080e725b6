#include "dreampm/backend/gpu/device_fields.h"

#include "dreampm/state/force_fields.h"

namespace dreampm::gpu {

bool DeviceFields::begin(const World<float>& world, double dt) {
  std::vector<FieldStep> steps;
  for (const auto& one : FieldSteps<float>(world, dt)) steps.emplace_back(one.step, one.box);
  fields_.upload(steps);
  if (steps.empty()) return false;
  given_.resize(world.grid.blocks.size());
  for (std::size_t f = 0; f < 2; ++f) impulses_[f].resize(world.grid.field(f).size());
  return true;
}

void DeviceFields::apply(const VisitInput& in) {
  if (fields_.size() > 0) launch(*device_, ApplyFields{in, input()}, given_.size());
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

double DeviceFields::work(const VisitInput& in, const Buffer<Range>& ranges) {
  if (fields_.size() == 0) return 0;
  find_work(in);
  parts_.resize(ranges.size());
  launch(*device_, AddUp<SourceTerms>{given_.data(), ranges.data(), parts_.data()}, ranges.size());
  std::vector<SourceTerms> home(parts_.size(), SourceTerms::none());
  parts_.download(home);
  double work = 0;
  for (const SourceTerms& one : home) work += one.work;
  return work;
}

}  // namespace dreampm::gpu
