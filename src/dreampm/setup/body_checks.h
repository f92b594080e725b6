// Checks of bodies: whether particles show the shape that they fill, and which spacing would.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dreampm/geometry/region.h"
#include "dreampm/geometry/sample.h"
#include "dreampm/level_set/level_set.h"
#include "dreampm/model/scene.h"

namespace dreampm {

/// Bounds without a distance field: voxels as coarse as a look at memory may want them would not
/// show a small mesh.
Box3d shape_bounds(const Shape& shape, double spacing, const Meshes& meshes);

/// The pattern and seed with which a body is filled.
struct Sampling {
  Pattern pattern;
  std::uint64_t seed;
};

/// make_region, where a mesh that encloses nothing is refused with the spacing that would do.
/// Meshes in combinations and containers are as fine as those of colliders, which are cut out that
/// way.
std::shared_ptr<const Region> body_region(const Shape& shape, double spacing, const Sampling& sampling,
                                          const Meshes& meshes);

/// "; it is about 0.004 m thick: a spacing of 0.002 m would do", for a shape that `spacing` does
/// not show. The spacing was tried: with it the particles hold the volume. Empty where nothing is
/// known and trying costs too much.
std::string finer_spacing(const Shape& shape, double spacing, const Sampling& sampling, const Meshes& meshes);

/// Returns the faults in the places of a body's points, a line a closed wall; empty if there are
/// none. `file` names the scene.
std::vector<std::string> outside_walls(const model::Body& body, const std::vector<Vec3d>& points,
                                       const model::Scene& scene, const std::string& file);

/// Returns the message for matter that lies beyond open sides, where it is taken out at once: an
/// error where no point is left, else a warning, with the volume, to `warnings`.
std::optional<std::string> beyond_open_sides(const model::Body& body, const std::vector<Vec3d>& points,
                                             const model::Scene& scene, const std::string& file,
                                             std::vector<std::string>& warnings);

/// A note for each wall that was rounded up away from a body which ends where `space.max` asks for
/// it.
std::vector<std::string> short_of_walls(const model::Body& body, const Box3d& bounds, const model::Space& space);

/// Collects what bodies hold, and says which hold more or less than their shapes by more than 5 %;
/// of lumps of less than 216 particles only what whole rows of them do not explain.
class VolumeCheck {
 public:
  VolumeCheck(double spacing, Meshes meshes) : spacing_(spacing), meshes_(std::move(meshes)) {}

  /// `particles` of spacing^3 fill `region`, which was made of `shape` at the spacing. `name` is
  /// for the text.
  void add(const std::string& name, const Shape& shape, const Region& region, const Sampling& sampling,
           std::size_t particles);
  /// A line for each of a few, one line for many.
  std::vector<std::string> warnings() const;

 private:
  struct Off {
    std::string name, advice;
    double holds, should;
  };
  double spacing_;
  Meshes meshes_;
  std::vector<Off> off_;
};

/// More than this part of its volume, a body should not gain or lose.
constexpr double volume_slack = 0.05;

}  // namespace dreampm
