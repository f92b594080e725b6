// The points of bodies before they are matter, and what is cut out of them.
#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dreampm/model/scene.h"
#include "dreampm/setup/body_checks.h"
#include "dreampm/state/world.h"

namespace dreampm {

struct Filling {
  std::shared_ptr<const Region> region;  ///< null for a point cloud
  std::vector<Vec3d> points;
  std::vector<Vec3d> velocities;  ///< m/s, beside the body's own; empty: none
  std::vector<std::size_t> cut;   ///< colliders of the world that were cut out of it
};

Filling fill(const model::Body& body, const model::Scene& scene, const Meshes& meshes, const Sampling& sampling);

/// Takes out what lies inside of the colliders that body `b` of the scene names, as they stand in
/// the world, whose box was laid. What is wrong where nothing is left.
std::optional<std::string> cut_out(Filling& filling, const model::Scene& scene, std::size_t b,
                                   const World<double>& world, const std::string& file);

/// m^3: where both have matter.
double common_volume(const Filling& a, const Filling& b, const World<double>& world, double spacing);

}  // namespace dreampm
