// A scene as plain data: what a scene file says, and what a program can build by itself. SI units,
// degrees, Y up. Every member has its default; docs/reference/scene.md has each with its range.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "dreampm/model/colliders.h"
#include "dreampm/model/foam.h"
#include "dreampm/model/force_field.h"
#include "dreampm/model/inflow.h"
#include "dreampm/model/matter.h"
#include "dreampm/model/motion.h"
#include "dreampm/model/probes.h"
#include "dreampm/model/render.h"
#include "dreampm/model/space.h"
#include "dreampm/vec.h"

namespace dreampm::model {

/// A position in a file, for messages that come later (a body outside the walls): 1-based; line 0:
/// none.
struct Mark {
  int line = 0, column = 0;
};

inline constexpr std::size_t most_materials = 256;    ///< files of particles number them in 8 bits
inline constexpr std::size_t most_colliders = 65535;  ///< points of surfaces number them in 16 bits

struct Scene {
  std::string name = "scene";  ///< names the run's folder and its video
  std::string about;
  std::uint64_t seed = 1;  ///< of all random numbers
  Space space;
  Time time;
  Vec3d gravity{0, -9.81, 0};              ///< m/s^2; with keys the first of them
  std::vector<Key<Vec3d>> gravity_keys{};  ///< by time; empty: constant
  std::vector<Material> materials;
  std::string start;  ///< the file of a moment to go on from, in place of bodies; empty: none
  std::vector<Body> bodies;
  std::vector<Collider> colliders;  ///< rigid bodies and pins, too
  std::vector<Emitter> emitters;
  std::vector<Sink> sinks;
  std::vector<ForceField> fields;
  std::vector<Probe> probes;
  Output output;
  std::optional<Foam> foam{};  ///< absent: none is made
  Surface surface;
  Render render;
  Video video;

  /// Positions by path ("bodies.drop"), for a scene that was read from a file.
  std::map<std::string, Mark> marks;
};

/// The number of the part of that name. Throws std::out_of_range where there is none.
template <class Part>
std::size_t index_of(const std::vector<Part>& parts, std::string_view name) {
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (parts[i].name == name) return i;
  throw std::out_of_range("no part of the name " + std::string(name));
}

}  // namespace dreampm::model
