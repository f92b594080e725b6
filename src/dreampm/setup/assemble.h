// A description becomes matter: shapes are built and filled, bulk moduli derived, walls and
// colliders set up.
#pragma once
#include <string>
#include <vector>

#include "dreampm/model/scene.h"
#include "dreampm/state/regroup.h"
#include "dreampm/state/world.h"

namespace dreampm {

/// A body's particles: ids [first_id, first_id + count).
struct BodyRange {
  std::string name;
  std::uint32_t first_id = 0, count = 0;
  std::optional<Vec3d> color;
  double time = 0;  ///< s, when it came in
};

/// The largest speed [m/s] that is expected, which liquids are made stiff for.
struct ExpectedSpeed {
  double speed = 0;
  std::string sources;  ///< ": fall 1.4 m/s, field gust 13 m/s"; empty without fields that give any
};

struct InitialState {
  World<double> world;                           ///< everything but particles; convert with as_world
  std::vector<std::vector<ParticleSeed>> seeds;  ///< by set
  std::vector<std::size_t> started;              ///< particles of the scene's start, by set; empty: it has none
  std::vector<BodyRange> bodies;
  ExpectedSpeed expected;
  std::vector<std::string> warnings, notes;

  std::size_t particles() const;
};

/// Builds the start of a run. `file` names the scene in messages. Throws InputError for a body
/// outside the walls or within a collider that does not hold it, one without particles, more matter
/// than memory holds; warns of overlapping bodies with their common volume, and of colliders that
/// are too thin. `standing`: colliders of the scene as they stand now, if not as it gives them;
/// their files are not read.
InitialState assemble(const model::Scene& scene, const std::string& file, std::span<const Collider> standing = {});

/// Makes `set` of that material: what it derives from the expected speed (bulk modulus, relaxation)
/// goes to its values and to `notes`; cells and gravity are those of `world`. Particles are left
/// alone.
template <class R>
void use_material(ParticleSet<R>& set, model::Material material, const World<R>& world, const ExpectedSpeed& expected,
                  std::vector<std::string>& notes);

/// The same empty world in float or double.
template <class R>
World<R> as_world(const World<double>& empty);

/// Bytes that a run of `particles` particles needs at most, particles and grid, with what sampling
/// and output take for a while. `colliders`: whether there are any; walls of them may be thin.
std::uint64_t memory_estimate(std::size_t particles, bool colliders);

}  // namespace dreampm
