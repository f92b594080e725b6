// Reports of a simulation: steps, frames, sums, names.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "dreampm/vec.h"

namespace dreampm {

/// The result of one step.
struct StepReport {
  std::uint64_t step = 0;       ///< steps so far, this one included
  double time = 0;              ///< s, after the step
  double dt = 0;                ///< s, taken
  std::string_view limiter;     ///< what limited dt: speed, wave, viscosity, frame, user
  int viscous_stages = 0;       ///< stages of viscosity in the step; 0: explicit
  bool frame_done = false;      ///< true if the step ended a frame
  double max_speed = 0;         ///< m/s, of the grid
  double j_min = 1, j_max = 1;  ///< range of the volume ratio J over all particles
};

/// The end of a frame.
struct FrameEvent {
  int frame = 1;            ///< whose time is now; frame 1 is the start
  double time = 0;          ///< s
  std::uint64_t steps = 0;  ///< in the frame that ended
};

/// Particles that are there, and those that came and went.
struct ParticleCounts {
  std::uint64_t particles = 0;
  std::uint64_t entered = 0;  ///< particles that `add` brought, in all
  std::uint64_t removed = 0;  ///< particles that `remove` took, in all
  std::uint64_t left = 0;     ///< particles that left through open walls, in all
  std::uint64_t drained = 0;  ///< particles that sinks took, in all
};

/// Sums over all matter as it stands, and what edits brought in and took out.
struct Totals : ParticleCounts {
  double mass = 0;                            ///< kg
  Vec3d momentum;                             ///< kg m/s
  double kinetic = 0;                         ///< J
  double elastic = 0;                         ///< J
  double volume = 0;                          ///< m^3
  double entered_mass = 0, removed_mass = 0;  ///< kg
  Vec3d entered_momentum, removed_momentum;   ///< kg m/s
};

/// The series that a probe of the scene has measured so far.
struct ProbeSeries {
  std::vector<std::string> columns;       ///< of a row
  std::vector<double> time;               ///< s, of each row; rises
  std::vector<std::vector<double>> rows;  ///< SI units; NaN: not defined then
};

/// The names of all objects of a simulation, in the order of its scene.
struct Names {
  std::vector<std::string> materials;
  std::vector<std::string> bodies;     ///< of matter
  std::vector<std::string> colliders;  ///< rigid bodies too
  std::vector<std::string> rigid;      ///< rigid bodies alone
  std::vector<std::string> emitters, sinks, probes;
  std::vector<std::string> fields;   ///< of force
  std::vector<std::string> brushes;  ///< brushes that are set
};

/// The settings that decide how long steps are.
struct Stepping {
  std::string_view solver;   ///< explicit or projection
  double cell = 0;           ///< m: edge of a cell of the grid
  double cfl = 0;            ///< cells that sound or matter may cross in a step
  double dt_max = 0;         ///< s: the longest step that the scene allows; 1e30: any
  double fixed_dt = 0;       ///< s: of every step; 0: it is chosen for each
  bool sub_cycles = false;   ///< true if steps may be longer than explicit viscosity allows
  int viscous_contacts = 0;  ///< kinds of contact that add to viscosity: with smooth walls, with solids
  int viscous_stages = 0;    ///< of the step to come; 0: its viscosity is explicit
};

}  // namespace dreampm
