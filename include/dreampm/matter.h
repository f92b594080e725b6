// Matter of a simulation: materials with their parameters, what is added, and brushes.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "dreampm/model/matter.h"
#include "dreampm/vec.h"

namespace dreampm {

/// A parameter of a material as it stands, of those that `dreampm materials` lists.
struct Parameter {
  std::string_view key;
  std::string_view unit;    ///< "1": a number without one
  double value = 0;         ///< NaN: the solver works it out
  double min = 0, max = 0;  ///< range of a value, both ends included
  std::string_view about;   ///< its meaning, in a line
  bool log = false;         ///< true if it is natural to move it by factors
  /// Words that may stand for a value, each with its number, as {"linear", 1}; false and true are 0
  /// and 1. Where `words_only`, no other value may be had.
  std::vector<std::pair<std::string_view, double>> words;
  bool words_only = false;
};

/// Another value of a parameter.
struct ParameterValue {
  std::string key;
  double value = 0;
};

/// A material as it stands.
struct MaterialState {
  std::string_view type;           ///< newtonian, elastic, snow, ...
  bool liquid = false;             ///< true if it has no shape of its own
  double particle_mass = 0;        ///< kg
  double particle_volume = 0;      ///< m^3, at rest
  double sound_speed = 0;          ///< m/s, at rest
  double kinematic_viscosity = 0;  ///< m^2/s, what bounds a step; 0 where the law solves it implicitly
  double poissons_ratio = 0;       ///< of small elastic strains [1]; 1/2 where volume alone resists
};

/// The particles that came in as a body, whatever has happened to them since.
struct BodyState {
  std::string material;          ///< the material of the body
  std::uint32_t first_id = 0;    ///< ids of its particles begin here
  std::uint32_t count = 0;       ///< number of these particles
  std::optional<Vec3d> color{};  ///< sRGB, 0 to 1; absent: as the look of its material
};

/// A particle that is added to a simulation, undeformed.
struct NewParticle {
  Vec3d position;    ///< m
  Vec3d velocity{};  ///< m/s
  /// 1/s, of the velocity about it: gradient[a] is that of component a, along x, y and z.
  std::array<Vec3d, 3> gradient{};
};

/// A stroke of the brush: it takes along what lies within a sphere, the more the nearer to its
/// middle.
struct VelocityBrush {
  Vec3d point;        ///< m: the middle
  double radius = 0;  ///< m, above 0
  Vec3d velocity{};   ///< m/s: where to
  double rate = 100;  ///< 1/s, at least 0: how fast matter at the middle comes to that velocity
};

}  // namespace dreampm
