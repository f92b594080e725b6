// What the foam stage finds of the frames of a run before it makes any foam.
#pragma once
#include "dreampm/foam/from_scene.h"
#include "dreampm/io/ply.h"
#include "dreampm/pipeline/run_folder.h"
#include "dreampm/setup/in_time.h"

namespace dreampm {

/// The matter of one kind in a frame, and how it lies in arrays.
struct FoamingMatter {
  std::vector<Vec3f> position, velocity;
  std::vector<std::int32_t> id;
  std::vector<float> volume_ratio;
  FoamMatter view() const { return {position, velocity, id, volume_ratio}; }
};
/// Of a particle file of the run. Throws InputError for one without velocities.
FoamingMatter foaming_matter(const RunFolder& run, int frame, const std::vector<int>& materials);

/// Colliders and rigid bodies of a run, frame by frame.
class FoamObstacles {
 public:
  /// `shift` [m]: from which places of the matter count. Throws InputError for a model that cannot
  /// be read.
  FoamObstacles(const model::Scene& scene, const Vec3d& shift);
  /// As at a frame, and as at `before`.
  std::vector<foam::Obstacle> at(const FrameRecord& frame, const FrameRecord& before) const;

 private:
  std::vector<SolidInTime> solids_;
  Vec3d shift_;
};

/// One kind of matter that foams in a run.
struct FoamingKind {
  std::vector<int> materials;
  FoamRules rules;
};

/// The kinds of the scene with their rules, limits included, found of all frames of the run where
/// the scene does not give them. What is found of a frame is kept in foam/maxima.csv. `found`: for
/// run.json, by the scene's keys.
std::vector<FoamingKind> foaming_kinds(RunFolder& run, const FoamObstacles& obstacles,
                                       std::map<std::string, double>& found);

}  // namespace dreampm
