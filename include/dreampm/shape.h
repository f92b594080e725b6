// A shape as plain data: a form, and where it stands.
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "dreampm/vec.h"

namespace dreampm {

struct Shape;

struct BoxShape {
  Vec3d size{1, 1, 1};  ///< m, each above 0
};
struct SphereShape {
  double radius = 1;  ///< m, above 0
};
/// Along y.
struct CylinderShape {
  double radius = 1, height = 1;  ///< m, above 0
};
/// The half-space behind a plane; of colliders and probes alone.
struct PlaneShape {
  Vec3d point{};          ///< m
  Vec3d normal{0, 1, 0};  ///< out of the solid; of any length above 0
};
struct MeshShape {
  std::string path;                   ///< a file, or asset:NAME
  std::optional<double> longest;      ///< fit: the longest side of its bounding box becomes this [m]
  std::optional<double> scale;        ///< or a plain factor
  std::optional<Box3d> heights = {};  ///< m: the file is a picture (PNG) of the heights in this box
};
/// A point cloud: one particle a point; of bodies alone.
struct PointsShape {
  std::string path;
  double scale = 1;
};
struct BooleanShape {
  enum class Op { unite, difference, intersection } op = Op::unite;
  std::vector<Shape> parts;  ///< at least two; difference: the first minus the others
};
/// A block or a wall about a hollow that is open at the top.
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
/// stays where its own coordinates put it; a mesh about the origin of its file). Boxes, spheres and
/// cylinders need a center.
struct Shape {
  std::variant<BoxShape, SphereShape, CylinderShape, PlaneShape, MeshShape, PointsShape, BooleanShape, ContainerShape>
      form;
  Vec3d rotate_axis{0, 1, 0};
  double rotate_angle = 0;      ///< degrees, by the right hand about the axis
  std::optional<Vec3d> center;  ///< m

  static Shape box(const Vec3d& min, const Vec3d& max) { return at(BoxShape{max - min}, (min + max) * 0.5); }  ///< m
  static Shape sphere(const Vec3d& center, double radius) { return at(SphereShape{radius}, center); }          ///< m
  /// Upright.
  static Shape cylinder(const Vec3d& center, double radius, double height) {
    return at(CylinderShape{radius, height}, center);
  }
  /// All that is behind a plane through `point`, whose normal points out of it.
  static Shape plane(const Vec3d& point, const Vec3d& normal) { return {PlaneShape{point, normal}, {0, 1, 0}, 0, {}}; }
  /// A mesh file where its own coordinates put it, which are in m.
  static Shape mesh(std::string file) {
    MeshShape mesh;
    mesh.path = std::move(file);
    return {std::move(mesh), {0, 1, 0}, 0, {}};
  }
  /// A mesh file at a size: its longest side [m], and where its middle lies.
  static Shape mesh(std::string file, double longest, const Vec3d& center) {
    MeshShape mesh;
    mesh.path = std::move(file), mesh.longest = longest;
    return at(std::move(mesh), center);
  }
  /// This shape, turned about its center.
  Shape turned(const Vec3d& axis, double degrees) const {
    Shape s = *this;
    s.rotate_axis = axis, s.rotate_angle = degrees;
    return s;
  }

  /// The union of both; the intersection; the first without the second.
  friend Shape operator|(Shape a, Shape b) { return combined(BooleanShape::Op::unite, std::move(a), std::move(b)); }
  friend Shape operator&(Shape a, Shape b) {
    return combined(BooleanShape::Op::intersection, std::move(a), std::move(b));
  }
  friend Shape operator-(Shape a, Shape b) {
    return combined(BooleanShape::Op::difference, std::move(a), std::move(b));
  }

 private:
  static Shape combined(BooleanShape::Op op, Shape a, Shape b);
  template <class Form>
  static Shape at(Form form, const Vec3d& center);
};

inline Shape Shape::combined(BooleanShape::Op op, Shape a, Shape b) {
  BooleanShape form{op, {}};
  form.parts.push_back(std::move(a)), form.parts.push_back(std::move(b));
  return {std::move(form), {0, 1, 0}, 0, {}};
}
template <class Form>
Shape Shape::at(Form form, const Vec3d& center) {
  return {std::move(form), {0, 1, 0}, 0, center};
}

}  // namespace dreampm
