// Probes: measurements of a scene while it runs, one struct for each type. ProbeForm is the list of
// types.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "dreampm/shape.h"
#include "dreampm/vec.h"

namespace dreampm {

/// The height of the free surface above the point (x, z).
struct HeightProbe {
  static constexpr std::string_view type = "height";
  double x = 0, z = 0;  ///< m
};

/// The pressure of the matter at a point of a wall.
struct PressureProbe {
  static constexpr std::string_view type = "pressure";
  Vec3d at;           ///< m
  Vec3d normal;       ///< out of the wall, into the matter; any length above 0
  double radius = 0;  ///< m, of the ball that it averages over; at least the spacing
};

/// The mean velocity of the matter around a point.
struct VelocityProbe {
  static constexpr std::string_view type = "velocity";
  Vec3d at;           ///< m
  double radius = 0;  ///< m, of the ball that it averages over; at least the spacing
};

/// The volume that passes a plane along its normal.
struct FluxProbe {
  static constexpr std::string_view type = "flux";
  Vec3d point;   ///< m
  Vec3d normal;  ///< any length above 0
};

/// A probe of the matter within a shape.
struct RegionProbe {
  static constexpr std::string_view type = "region";
  Shape shape;
};

/// The force of the matter on a wall or a collider.
struct ForceProbe {
  static constexpr std::string_view type = "force";
  std::string on;  ///< a wall (floor, ceiling, x_min, ...), collider or rigid body
};

/// A probe of the extent of matter along an axis.
struct ExtentProbe {
  static constexpr std::string_view type = "extent";
  std::uint8_t axis = 0;      ///< x, y, z
  std::string material = {};  ///< the name of one; empty: all matter
};

/// A material point of a body: the one that starts at `at`.
struct PointProbe {
  static constexpr std::string_view type = "point";
  std::string body;  ///< the name of one
  Vec3d at;          ///< m
};

/// A probe of the pose and velocity of a collider or rigid body.
struct PoseProbe {
  static constexpr std::string_view type = "pose";
  std::string on;  ///< the name of one
};

/// A probe of the matter that came in by an emitter, or went out by a sink.
struct InflowProbe {
  static constexpr std::string_view type = "inflow";
  std::string on;  ///< an emitter, a sink, or a collider that deletes
};

using ProbeForm = std::variant<HeightProbe, PressureProbe, VelocityProbe, FluxProbe, RegionProbe, ForceProbe,
                               ExtentProbe, PointProbe, PoseProbe, InflowProbe>;

namespace model {

struct Probe {
  std::string name;  ///< of its file: probes/NAME.csv
  double rate = 0;   ///< samples a second of simulated time; 0: once a frame
  ProbeForm form;
};

}  // namespace model
}  // namespace dreampm
