// The `start` of a scene: a moment of a simulation, from which another one goes on.
#pragma once
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "dreampm/backend/motion.h"
#include "dreampm/setup/assemble.h"

namespace dreampm {

/// The format of the archive of a moment that a scene may start from.
inline constexpr const char* start_format = "dreampm-start";

/// The content of a file of a moment, without its particles.
struct StartInfo {
  int frame = 1;
  double time = 0;                                             ///< s
  std::vector<std::pair<std::string, std::size_t>> particles;  ///< of each material, by its name
  Vec3d momentum{};                                            ///< kg m/s
  ExpectedSpeed expected;                                      ///< that liquids were made stiff for

  /// Returns the number of particles of a material; 0 where it is not there.
  std::size_t count(std::string_view material) const;
};
/// Throws InputError for what is no such file.
StartInfo start_info(const std::filesystem::path& file);

/// The frame that a run of the scene begins with: 1 without a start. Throws as start_info.
int first_frame(const model::Scene& scene);

/// Writes what decides the future. `world` and `motion` must be current in memory
/// (Engine::download), and the grid formed.
template <class R>
void write_start(const std::filesystem::path& file, const World<R>& world, const Motion<R>& motion,
                 const ExpectedSpeed& expected);

/// Reads what `write_start` wrote into the empty `world` of a scene of `frames` frames, and its
/// motion. Whether the world is as it was then, to the bit; else its grid must be formed anew.
/// Throws InputError for a start of another spacing, space or precision, or without one of the
/// materials.
template <class R>
bool read_start(const std::filesystem::path& file, int frames, World<R>& world, Motion<R>& motion);

}  // namespace dreampm
