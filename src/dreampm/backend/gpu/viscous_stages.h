// The stages of viscosity of a World in a device's memory, in place of GridUpdate::sub_cycle.
#pragma once
#include <array>

#include "dreampm/backend/gpu/grid_visit.h"
#include "dreampm/backend/gpu/particle_passes.h"
#include "dreampm/backend/stage_sums.h"

namespace dreampm::gpu {

class ViscousStages {
 public:
  explicit ViscousStages(Device& device)
      : device_(&device),
        old_{Buffer<Node<float>>(device), Buffer<Node<float>>(device)},
        change_{Buffer<Node<float>>(device), Buffer<Node<float>>(device)},
        driven_(device) {}
  /// As Backend::sub_cycle. `next`: a grid as long as the World's.
  double operator()(World<float>& world, Memory& memory, GridVisit& visit, ParticlePasses& passes,
                    GridFields<float>& next, double dt, GridStats& found);

 private:
  Device* device_;
  std::array<Buffer<Node<float>>, 2> old_, change_;  ///< by field
  Buffer<SourceTerms> driven_;
  StageSums sums_;
};

}  // namespace dreampm::gpu
