// What a scene says of a shape, as plain data; geometry/region.h turns it into something that can
// be asked.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "dreampm/math/vec.h"

namespace dreampm {

struct Shape;

struct BoxShape {
  Vec3d size{1, 1, 1};  ///< m; {min, max} in a scene become size and center
};
struct SphereShape {
  double radius = 1;  ///< m
};
struct CylinderShape {
  double radius = 1, height = 1;  ///< m, axis Y
};
/// The half-space below a plane; colliders only.
struct PlaneShape {
  Vec3d point{}, normal{0, 1, 0};
};
struct MeshShape {
  std::string path;               ///< a file, or asset:NAME
  std::optional<double> longest;  ///< fit: the longest side of its bounding box becomes this [m]
  std::optional<double> scale;    ///< or a plain factor
};
/// A point cloud: one particle a point; bodies only.
struct PointsShape {
  std::string path;
  double scale = 1;
};
struct BooleanShape {
  enum class Op { unite, difference, intersection } op = Op::unite;
  std::vector<Shape> parts;  ///< difference: the first minus the others
};

/// A form, rotated about its own centre, then moved so that its centre lies at `center` (absent:
/// stays where its own coordinates put it; a mesh about the origin of its file).
struct Shape {
  std::variant<BoxShape, SphereShape, CylinderShape, PlaneShape, MeshShape, PointsShape, BooleanShape> form;
  Vec3d rotate_axis{0, 1, 0};
  double rotate_angle = 0;  ///< degrees
  std::optional<Vec3d> center;
};

}  // namespace dreampm
