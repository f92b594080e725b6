// What a file or a run's folder holds, in numbers.
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "dreampm/math/vec.h"

namespace dreampm {

using Fact = std::variant<std::string, std::uint64_t, double>;

/// What is not known stays absent.
struct Inspection {
  std::string kind;         ///< scene | mesh | particles | points | run | checkpoint | start
  std::uint64_t count = 0;  ///< bodies, vertices, particles, frames or arrays
  std::optional<Box3d> bounds;
  std::vector<std::string> attributes;
  std::optional<double> mass;     ///< kg
  std::optional<Vec3d> momentum;  ///< kg m/s
  std::optional<double> volume;   ///< m^3
  std::optional<std::string> state_hash;
  std::map<std::string, std::uint64_t> by_material;  ///< particles of each
  std::map<std::string, Fact> facts;                 ///< what else there is to say, by name
};

/// Looks at a scene (.yaml), a mesh, a particle PLY or any cloud of points, a checkpoint or a
/// moment to start from (.h5) or a run's folder. Mass, momentum and hash of a particle file come
/// from the run that it lies in, those of a run from its last frame; the volume of a run's mesh
/// stands beside that of its particles. A scene is filled with particles to know its mass. Throws
/// InputError for a file that is damaged or none of these.
Inspection inspect(const std::filesystem::path& path);

}  // namespace dreampm
