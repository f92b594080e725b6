// A probe: a few numbers measured while a scene runs. Each type has a file of its own;
// scene/probes.h lists the types. A new one: its struct there, its keys in scene/probes.cpp, and
// here a declaration and a file.
#pragma once
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dreampm/geometry/region.h"
#include "dreampm/model/scene.h"
#include "dreampm/solver/step.h"
#include "dreampm/state/particle_view.h"
#include "dreampm/state/regroup.h"

namespace dreampm {

/// The state at the end of a step, from which probes sample. `motion` is of the step's pass. Of the
/// arrays only what Probe::fields names is current.
template <class R>
struct ProbeContext {
  const World<R>& world;
  const Motion<R>& motion;
  ParticleSetView<R> particles(std::size_t set) const { return {world, set}; }
};

/// The start of a scene, from which a probe finds what it will follow: the same at the start and at
/// a resume.
struct ProbeStart {
  struct Body {
    std::string name;
    std::size_t set;                ///< that its particles belong to
    std::uint32_t first_id, count;  ///< its particles
  };
  const World<double>& world;                        ///< walls, cells, sets: no particles yet
  std::span<const std::vector<ParticleSeed>> seeds;  ///< by set
  std::vector<Body> bodies;
  double spacing;  ///< m
  MeshRegions meshes;
};

template <class R>
class Probe {
 public:
  virtual ~Probe() = default;
  /// Names of what sample returns, beside the time.
  virtual std::vector<std::string> columns() const = 0;
  /// Returns the fields that sample reads.
  virtual MatterFields fields() const = 0;
  /// Called after every step.
  virtual void accumulate(const StepSums&) {}
  /// One row. Nothing if there is none yet: a mean over an interval has no value at the start. NaN:
  /// not defined now (the velocity where nothing is).
  virtual std::optional<std::vector<double>> sample(const ProbeContext<R>& now) = 0;
  /// Returns its state from row to row, for a checkpoint.
  virtual std::vector<double> memory() const { return {}; }
  virtual void restore(const std::vector<double>&) {}
};

/// Throws InputError, naming the probe, if it can measure nothing (a material point where the body
/// has no matter).
template <class R>
std::unique_ptr<Probe<R>> make_probe(const model::Probe& probe, const ProbeStart& start);

// One for each type, in the file of that name.
template <class R>
std::unique_ptr<Probe<R>> make_one(const HeightProbe&, const std::string& name, const ProbeStart&);
template <class R>
std::unique_ptr<Probe<R>> make_one(const PressureProbe&, const std::string& name, const ProbeStart&);
template <class R>
std::unique_ptr<Probe<R>> make_one(const VelocityProbe&, const std::string& name, const ProbeStart&);
template <class R>
std::unique_ptr<Probe<R>> make_one(const FluxProbe&, const std::string& name, const ProbeStart&);
template <class R>
std::unique_ptr<Probe<R>> make_one(const RegionProbe&, const std::string& name, const ProbeStart&);
template <class R>
std::unique_ptr<Probe<R>> make_one(const ForceProbe&, const std::string& name, const ProbeStart&);
template <class R>
std::unique_ptr<Probe<R>> make_one(const ExtentProbe&, const std::string& name, const ProbeStart&);
template <class R>
std::unique_ptr<Probe<R>> make_one(const PointProbe&, const std::string& name, const ProbeStart&);

template <class R>
std::unique_ptr<Probe<R>> make_one(const PoseProbe&, const std::string& name, const ProbeStart&);
template <class R>
std::unique_ptr<Probe<R>> make_one(const InflowProbe&, const std::string& name, const ProbeStart&);

/// The way to the nearest copy of a point that is `way` [m] off: shorter than half a period on
/// periodic axes.
template <class R>
Vec3d nearest_copy(const World<R>& world, Vec3d way) {
  for (int a = 0; a < 3; ++a) {
    if (!world.periodic[static_cast<std::size_t>(a)]) continue;
    const double period = (world.high[a] - world.low[a]) * world.dx;
    way[a] -= period * std::round(way[a] / period);
  }
  return way;
}

/// The box of the walls [m].
template <class R>
Box3d box_of(const World<R>& world) {
  return {world.origin, world.origin + static_cast<Vec3d>(world.high - world.low) * world.dx};
}

/// The edge [m] of the cube that a particle stands for at rest.
template <class R>
double edge_of(const ParticleSet<R>& set) {
  return std::cbrt(set.rest_volume);
}

}  // namespace dreampm
