// The gaps of solids and grains before walls and colliders, measured on a device in place of
// ContactGaps.
#pragma once
#include <cstdint>
#include <vector>

#include "dreampm/backend/contact_gap.h"
#include "dreampm/backend/gpu/launch.h"
#include "dreampm/backend/gpu/set_memory.h"

namespace dreampm::gpu {

class GapMeasure {
 public:
  explicit GapMeasure(Device& device)
      : device_(&device),
        near_(device),
        near_colliders_(device),
        planes_(device),
        gaps_of_(device),
        walls_of_(device),
        gaps_(device),
        gap_(device) {}
  /// Must be called after the same of `gaps`: after every change of the grid's block list, of the
  /// particles' order or of colliders.
  void prepare(const World<float>& world, const Obstacles& obstacles, const ContactGaps& gaps);
  /// True if any matter has gaps.
  bool any() const { return gapped_[0] || gapped_[1]; }
  /// Finds all gaps at the particles' places. `thin`: whether SetMemory::distance is to be read.
  void measure(const World<float>& world, Memory& memory, bool thin);
  /// The gaps before walls of a field of the grid.
  GapPointers pointers(std::size_t field) const {
    return gapped_[field] ? GapPointers{walls_of_.data(), gap_.data()} : GapPointers{};
  }
  /// All gaps by number, side and node; null where matter of that field of the grid has none.
  const std::int32_t* cells(std::size_t field) const { return gapped_[field] ? gaps_.data() : nullptr; }

 private:
  Device* device_;
  bool gapped_[2] = {};  ///< by field
  Buffer<NearWalls> near_;
  Buffer<std::uint32_t> near_colliders_;
  Buffer<WallPlane> planes_;
  Buffer<std::int32_t> gaps_of_, walls_of_, gaps_;
  Buffer<float> gap_;
};

}  // namespace dreampm::gpu
