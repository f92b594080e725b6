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
  std::string path;                   ///< a file, or asset:NAME
  std::optional<double> longest;      ///< fit: the longest side of its bounding box becomes this [m]
  std::optional<double> scale;        ///< or a plain factor
  std::optional<Box3d> heights = {};  ///< m: the file is a picture of the heights in this box (heightfield.h)
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
/// A block or a wall about a hollow that is open at the top: geometry/container.h says how it is
/// built.
struct ContainerShape {
  enum class Open { top };
  enum class Form { block, shell };
  std::vector<Shape> hollow;  ///< one: what is hollow, before it is turned and cut open
  double wall = 0.02;         ///< m; of a block at the thinnest places
  Open open = Open::top;      ///< where the hollow is cut open
  Vec3d up{0, 1, 0};          ///< the direction of the hollow that points up
  std::optional<double> cut;  ///< m below its highest point; absent: 0.05 of its height
  Form form = Form::block;    ///< the box about it, or a wall that follows it
};

/// A form, rotated about its own center, then moved so that its center lies at `center` (absent:
/// stays where its own coordinates put it; a mesh about the origin of its file).
struct Shape {
  std::variant<BoxShape, SphereShape, CylinderShape, PlaneShape, MeshShape, PointsShape, BooleanShape, ContainerShape>
      form;
  Vec3d rotate_axis{0, 1, 0};
  double rotate_angle = 0;  ///< degrees
  std::optional<Vec3d> center;
};

}  // namespace dreampm
