// The force fields of a World at nodes in a device's memory.
#pragma once
#include <array>

#include "dreampm/backend/gpu/launch.h"
#include "dreampm/backend/gpu/set_memory.h"

namespace dreampm::gpu {

class DeviceFields {
 public:
  explicit DeviceFields(Device& device)
      : device_(&device),
        fields_(device),
        impulses_{Buffer<Vec3<float>>(device), Buffer<Vec3<float>>(device)},
        given_(device),
        parts_(device) {}
  /// Sends what the fields do in a step of `dt` [s]. True if there are any: all blocks wait then.
  bool begin(const World<float>& world, double dt);
  /// Changes the velocities of nodes.
  void apply(const VisitInput& in);
  /// Finds their work, as the nodes move now.
  void find_work(const VisitInput& in);
  /// What they gave, by block of the grid; null without fields.
  const SourceTerms* given() const { return fields_.size() > 0 ? given_.data() : nullptr; }
  /// The sum of their work [J], as the nodes move now; `ranges`: of the blocks of the grid.
  double work(const VisitInput& in, const Buffer<Range>& ranges);

 private:
  FieldInput input() const;

  Device* device_;
  Buffer<FieldStep> fields_;
  std::array<Buffer<Vec3<float>>, 2> impulses_;  ///< kg m/s, by field of the grid and node
  Buffer<SourceTerms> given_, parts_;
};

}  // namespace dreampm::gpu
