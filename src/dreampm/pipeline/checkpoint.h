// A world on disk, and back: the same bits.
#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "dreampm/simulation/probe_set.h"
#include "dreampm/solver/step.h"

namespace dreampm {

/// What a frame's ledger row sums up over its steps; part of a checkpoint that falls within a
/// frame.
struct FrameSums {
  std::uint64_t substeps = 0;
  double dt_min = 1e30, dt_max = 0;
  Limiter limiter = Limiter::frame;
  int stages = 0;        ///< of viscosity, the most of a step
  ImpulseSum contact;    ///< what matter received from walls and colliders
  ImpulseSum body;       ///< and from gravity, damping and fields
  ImpulseSum left;       ///< what left took along
  Entered entered;       ///< what emitters gave
  double left_mass = 0;  ///< kg
  PassEnergy lost;       ///< what the particles turned into heat; kinetic and keeping unused
  double transfer = 0;   ///< J, of StepSums
  double damping = 0;    ///< J that damping took
  double rounding = 0;   ///< N s, of StepSums
  double jumps = 0;      ///< N m s by which pushing particles back inside may have changed the angular momentum
  double grid_mass = 0;  ///< kg on the nodes, at the last step
  std::optional<double> swollen;    ///< m^3, of StepSums, at the last step that had it
  std::optional<double> projected;  ///< J, of StepSums
  /// `heaviest`: mass of the heaviest particle [kg].
  void add(const StepSums& step, double heaviest);
};

struct CheckpointInfo {
  std::string scene_hash, backend, isa;
  FrameSums sums;
  std::uint64_t particle_steps = 0;
  ProbeMemories probes;
  // Set by checkpoint_info alone: where the world in the file stands.
  int frame = 0;
  double time = 0;              ///< s
  std::uint64_t particles = 0;  ///< of all sets
};

template <class R>
void save_checkpoint(const std::filesystem::path& file, const World<R>& world, const CheckpointInfo& info);

/// Who wrote it and where it stands, without loading it.
CheckpointInfo checkpoint_info(const std::filesystem::path& file);

/// Fills `world`, which was assembled from the same scene. Throws InputError for a file of another
/// scene, precision, version or one that is damaged.
template <class R>
CheckpointInfo load_checkpoint(const std::filesystem::path& file, const std::string& scene_hash, World<R>& world);

}  // namespace dreampm
