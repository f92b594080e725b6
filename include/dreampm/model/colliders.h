// Colliders, which matter meets: at rest, in a given motion, and rigid bodies.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "dreampm/model/motion.h"
#include "dreampm/shape.h"
#include "dreampm/vec.h"
#include "dreampm/walls.h"

namespace dreampm {

/// Pulls the center of mass of a rigid body to a point.
struct Spring {
  Vec3d to{};            ///< m
  double stiffness = 0;  ///< N/m, above 0
  double damping = 0;    ///< N s/m, at least 0
};

namespace model {

/// The settings that make a collider a rigid body.
struct Rigid {
  std::optional<double> density{};  ///< kg/m^3, 0.1 to 30000; or
  std::optional<double> mass{};     ///< kg, above 0
  Vec3d velocity{};                 ///< m/s, at the start
  Vec3d spin{};                     ///< rad/s about its center of mass, at the start
  double restitution = 0;           ///< of impacts, 0 to 1
  std::array<bool, 6> locked{};     ///< x, y, z, rx, ry, rz: axes along which it does not move, or turn about
  std::optional<Spring> spring{};
};

/// A collider as a mesh that deforms: a file a frame.
struct MeshSequence {
  std::vector<std::string> files;  ///< at least two, by time
  double fps = 24;                 ///< files a second, the first at time 0
  double scale = 1;                ///< m per unit of the files
};

/// A solid that matter meets. Colliders, rigid bodies and pins share their names.
struct Collider {
  std::string name;
  Shape shape{};                           ///< not used with a sequence
  std::optional<MeshSequence> sequence{};  ///< in place of a shape: one that deforms
  WallType type = WallType::separate;      ///< separate, slip or stick
  /// Coulomb's coefficient, 0 to 100; of separate and slip. Between rigid bodies the product of
  /// both.
  double friction = 0;
  double sticky = 0;                  ///< Pa: the tension that it holds matter with; of type separate
  std::optional<double> voxel{};      ///< m: of the distances from meshes; absent: the spacing, finer for thin walls
  bool deletes = false;               ///< true if matter that touches it is taken out
  std::optional<double> thickness{};  ///< m: the shell about the surface of its shape, half of it on either side
  bool holds = false;                 ///< true if matter that starts inside is held there, and moves with it
  std::optional<Motion> motion{};     ///< absent: it stands
  std::optional<Rigid> rigid{};       ///< matter and impacts move it
  bool pin = false;                   ///< it only holds matter, and is not drawn
};

}  // namespace model
}  // namespace dreampm
