#include "dreampm/rigid/bullet_forms.h"

#include <LinearMath/btConvexHullComputer.h>

#include <numbers>

#include "dreampm/base/error.h"
#include "dreampm/rigid/bullet_vectors.h"
#include "dreampm/rigid/exact_forms.h"

namespace dreampm {
namespace {

/// The convex hull of a body over its volume, from which on what lies in its hollows is met.
constexpr double hollow_from = 1.05;

/// Six times what a triangle and the origin span.
double spanned(const Vec3d& a, const Vec3d& b, const Vec3d& c) { return dot(a, cross(b, c)); }

double volume_of(const TriMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles)
    sum += spanned(static_cast<Vec3d>(mesh.vertices[t[0]]), static_cast<Vec3d>(mesh.vertices[t[1]]),
                   static_cast<Vec3d>(mesh.vertices[t[2]]));
  return std::abs(sum) / 6;
}

struct Hull {
  std::vector<Vec3d> vertices;
  double volume = 0;
};
Hull hull_of(const TriMesh& mesh) {
  btConvexHullComputer computer;
  computer.compute(&mesh.vertices[0].x, sizeof(Vec3f), static_cast<int>(mesh.vertices.size()), 0, 0);
  Hull hull;
  for (int v = 0; v < computer.vertices.size(); ++v) hull.vertices.push_back(from_bullet(computer.vertices[v]));
  double sum = 0;
  for (int f = 0; f < computer.faces.size(); ++f) {
    const auto* first = &computer.edges[computer.faces[f]];
    const Vec3d& from = hull.vertices[static_cast<std::size_t>(first->getSourceVertex())];
    for (const auto* e = first->getNextEdgeOfFace(); e->getTargetVertex() != first->getSourceVertex();
         e = e->getNextEdgeOfFace())
      sum += spanned(from, hull.vertices[static_cast<std::size_t>(e->getSourceVertex())],
                     hull.vertices[static_cast<std::size_t>(e->getTargetVertex())]);
  }
  hull.volume = std::abs(sum) / 6;
  return hull;
}

/// Makes the form of each kind of shape: that of Bullet where it has one, else of the mesh.
struct MakeForm {
  const CollisionShape& collision;
  bool rigid;
  Vec3d corner;
  Form& form;

  void operator()(const BoxShape& box) const { form.shape = std::make_unique<btBoxShape>(bullet(box.size * 0.5)); }
  void operator()(const SphereShape& sphere) const { form.shape = std::make_unique<btSphereShape>(sphere.radius); }
  void operator()(const CylinderShape& cylinder) const {
    form.shape = std::make_unique<btCylinderShape>(btVector3(cylinder.radius, cylinder.height / 2, cylinder.radius));
  }
  void operator()(const PlaneShape& plane) const {
    const Vec3d n = normalized(plane.normal);
    form.shape = std::make_unique<btStaticPlaneShape>(bullet(n), 0);
    form.placement = {plane.point, {}};
  }
  template <class Other>
  void operator()(const Other&) const {
    static_assert(!is_exact_form<Other>);
    surface();
  }
  void operator()(const PointsShape&) const { fail_input("a cloud of points has no surface that bodies could meet"); }

  /// Adds the form of a surface: for a body its convex hull, or a form by distance where that holds
  /// a hollow; else its triangles.
  void surface() const {
    const TriMesh& mesh = *collision.mesh;
    form.placement = {corner, {}};
    if (rigid) {
      const Hull hull = hull_of(mesh);
      if (hull.volume > hollow_from * volume_of(mesh)) {
        form.by_distance = true;
        for (const Vec3d& v : hull.vertices) form.hull.push_back(v + corner);
        return;
      }
      auto convex = std::make_unique<btConvexHullShape>();
      for (const Vec3d& v : hull.vertices) convex->addPoint(bullet(v), false);
      convex->recalcLocalAabb();
      form.shape = std::move(convex);
      return;
    }
    form.triangles = std::make_unique<btTriangleMesh>();
    for (const auto& t : mesh.triangles)
      form.triangles->addTriangle(bullet(static_cast<Vec3d>(mesh.vertices[t[0]])),
                                  bullet(static_cast<Vec3d>(mesh.vertices[t[1]])),
                                  bullet(static_cast<Vec3d>(mesh.vertices[t[2]])));
    form.shape = std::make_unique<btBvhTriangleMeshShape>(form.triangles.get(), true);
  }
};

}  // namespace

Pose placement_of(const Shape& shape) {
  const double angle = shape.rotate_angle * std::numbers::pi / 180;
  return {shape.center.value_or(Vec3d{}), Quaternion::about(normalized(shape.rotate_axis) * angle)};
}

Form form_of(const CollisionShape& collision, const Collider& collider, double margin, const Vec3d& corner) {
  Form form;
  if (collider.changing) {
    form.by_distance = true;
  } else {
    // A shape that is a mesh by now may have been any shape: a shell about it, or one without a
    // form of its own.
    form.placement = placement_of(collision.shape);
    if (collision.mesh)
      MakeForm{collision, collider.rigid, corner, form}.surface();
    else
      std::visit(MakeForm{collision, collider.rigid, corner, form}, collision.shape.form);
  }
  if (form.by_distance) form.shape = std::make_unique<DistanceShape>();
  // The margin of a ball is its radius.
  if (!std::holds_alternative<SphereShape>(collision.shape.form) || collision.mesh) form.shape->setMargin(margin);
  return form;
}

}  // namespace dreampm
