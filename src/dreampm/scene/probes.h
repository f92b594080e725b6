// What a scene measures while it runs: one struct per type of probe, plain data. ProbeForm is the
// one list of types: the parser, the emitter and solver/probe/ all go through it.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "dreampm/geometry/shape.h"
#include "dreampm/math/vec.h"
#include "dreampm/scene/mark.h"

namespace dreampm {

/// The height of the free surface above the point (x, z).
struct HeightProbe {
  static constexpr std::string_view type = "height";
  double x = 0, z = 0;  ///< m
};

/// The pressure of the matter at a point of a wall.
struct PressureProbe {
  static constexpr std::string_view type = "pressure";
  Vec3d at;      ///< m
  Vec3d normal;  ///< out of the wall, into the matter; any length above 0
  double radius = 0;
};

/// The mean velocity of the matter around a point.
struct VelocityProbe {
  static constexpr std::string_view type = "velocity";
  Vec3d at;  ///< m
  double radius = 0;
};

/// The volume that passes a plane along its normal.
struct FluxProbe {
  static constexpr std::string_view type = "flux";
  Vec3d point, normal;  ///< m; any length above 0
};

/// What lies within a shape.
struct RegionProbe {
  static constexpr std::string_view type = "region";
  Shape shape;
};

/// The force of the matter on a wall or a collider.
struct ForceProbe {
  static constexpr std::string_view type = "force";
  std::string on;     ///< as the scene calls it
  int wall = -1;      ///< x_min .. z_max as 0 .. 5, or -1
  int collider = -1;  ///< index into the scene's colliders, or -1
};

/// From where to where matter reaches along an axis.
struct ExtentProbe {
  static constexpr std::string_view type = "extent";
  std::uint8_t axis = 0;  ///< x, y, z
  int material = -1;      ///< index into the scene's materials; -1: all of them
};

/// A material point of a body: the one that starts at `at`.
struct PointProbe {
  static constexpr std::string_view type = "point";
  int body = 0;  ///< index into the scene's bodies
  Vec3d at;      ///< m
};

/// Where a collider or rigid body stands, and how it moves.
struct PoseProbe {
  static constexpr std::string_view type = "pose";
  int collider = -1;  ///< index into the scene's colliders
};

/// What comes in by an emitter, or goes out by a sink.
struct InflowProbe {
  static constexpr std::string_view type = "inflow";
  std::string on;    ///< as the scene calls it
  int emitter = -1;  ///< index into the scene's emitters, or -1
  int sink = -1;     ///< index into its sinks, after which come its colliders that delete, or -1
};

using ProbeForm = std::variant<HeightProbe, PressureProbe, VelocityProbe, FluxProbe, RegionProbe, ForceProbe,
                               ExtentProbe, PointProbe, PoseProbe, InflowProbe>;

namespace scene {
struct Probe {
  std::string name;  ///< of its file: probes/NAME.csv
  double rate = 0;   ///< samples a second of simulated time; 0: once a frame
  ProbeForm form;
  Mark mark = {};
};
}  // namespace scene

}  // namespace dreampm
