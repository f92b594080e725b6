// How full the containers of a run are, frame by frame, from its scene and its particles alone.
#pragma once
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dreampm/geometry/hollow.h"
#include "dreampm/io/ply.h"
#include "dreampm/io/series.h"
#include "dreampm/pipeline/run_folder.h"
#include "dreampm/state/collider.h"

namespace dreampm {

/// One container in one frame.
struct FillReport {
  std::string collider;
  double reachable = 0;         ///< m^3 that liquid can reach
  double filled = 0;            ///< m^3 of that
  double fraction = 0;          ///< filled / reachable; 0 where nothing can be reached
  double leaked = 0;            ///< m^3 of liquid outside of the hollow and below the spill level
  std::vector<Pocket> pockets;  ///< the largest first
};

using ColliderRegions = std::vector<std::shared_ptr<const Region>>;
/// Of colliders as a simulation has them.
ColliderRegions regions_of(const std::vector<Collider>& colliders);
/// Of a scene's colliders, where one of them is a container; else none, and nothing is read. Throws
/// InputError for one that cannot be made.
ColliderRegions regions_of(const model::Scene& scene);

/// The hollow of a collider that is a container, as liquid finds it.
struct ColliderHollow {
  std::string collider;
  HollowCells cells;
  double mouth = 0;  ///< m^2
};
/// Of every collider that is a container, in the frame of its shape, where the scene puts it.
/// `regions`: those of all
/// colliders of the scene, in its order. Cells are those of the grid; up is against the scene's
/// gravity, +Y without one; the other colliders take room. Throws InputError for a hollow of too
/// many cells.
std::vector<ColliderHollow> collider_hollows(const model::Scene& scene, const ColliderRegions& regions);

/// What `check` says of them: what each holds, and a warning where nothing can be reached.
struct HollowLines {
  std::vector<std::string> notes, warnings;
};
HollowLines hollow_lines(const model::Scene& scene, const ColliderRegions& regions);

/// Where colliders stand, by name: those that the scene does not move itself.
using ColliderPoses = std::map<std::string, Pose>;

/// Measures frames of a scene.
class FillMeter {
 public:
  FillMeter(const model::Scene& scene, const ColliderRegions& regions);
  /// No collider is a container: there is nothing to measure.
  bool empty() const { return hollows_.empty(); }
  const std::vector<ColliderHollow>& hollows() const { return hollows_; }
  /// A report for each container, in the order of the scene. Particles of liquids count, each with
  /// the volume that it has at rest. A container is measured where it stands at `time` [s].
  std::vector<FillReport> measure(const ParticleFrame& frame, double time, const ColliderPoses& poses);

 private:
  /// All colliders as they stand now.
  std::vector<Pose> poses_at(double time, const ColliderPoses& poses) const;
  /// Finds the hollows anew that lie otherwise than before: tilted, or with others elsewhere in
  /// them.
  void place(const std::vector<Pose>& poses);

  std::vector<ColliderHollow> hollows_;
  std::vector<std::string> names_;  ///< of all colliders
  ColliderRegions regions_;
  std::vector<std::shared_ptr<const MotionPath>> paths_;
  std::vector<Pose> placed_;  ///< for which hollows_ are
  Vec3d up_;
  double dx_ = 0;  ///< m
  std::vector<std::string> liquids_;
  double particle_ = 0;  ///< m^3
};

/// fill.csv in a run's folder: a row a frame.
class FillSeries {
 public:
  FillSeries(const model::Scene& scene, const ColliderRegions& regions, const std::filesystem::path& folder);
  /// A new file; that of an earlier run is removed.
  void begin();
  /// Goes on after `time` [s]; a run that has no file yet begins one.
  void resume(double time);
  void append(double time, int number, const ParticleFrame& frame, const ColliderPoses& poses);

 private:
  FillMeter meter_;
  std::filesystem::path file_;
  std::optional<SeriesWriter> writer_;
};

/// The reports of one frame of a run, of the last without one. Throws InputError for a run without
/// a container and for a frame that it does not have.
struct FrameFill {
  int frame = 1;
  double time = 0;  ///< s
  std::vector<FillReport> reports;
};
FrameFill frame_fill(const RunFolder& run, std::optional<int> frame);

}  // namespace dreampm
