#include "dreampm/rigid/bullet_contacts.h"

#include <btBulletDynamicsCommon.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <deque>
#include <numbers>

namespace dreampm {
namespace {

btVector3 bullet(const Vec3d& v) { return {v.x, v.y, v.z}; }
Vec3d from_bullet(const btVector3& v) { return {v.x(), v.y(), v.z()}; }
btQuaternion bullet(const Quaternion& q) { return {q.x, q.y, q.z, q.w}; }
btTransform bullet(const Pose& p) { return btTransform(bullet(p.rotation), bullet(p.position)); }

/// Half of what two bodies may be apart and still touch [cells].
constexpr double margin = 0.02;
/// The part of what two bodies lie within each other that a step pushes apart.
constexpr double push_apart = 0.1;
/// Points of a face to look for at least where two bodies touch.
constexpr int face_points = 4;
/// Iterations over all contacts: stacks of bodies start each step from nothing.
constexpr int iterations = 60;

/// Where the form of a shape stands in the shape.
Pose placement(const Shape& shape) {
  const double angle = shape.rotate_angle * std::numbers::pi / 180;
  return {shape.center.value_or(Vec3d{}), Quaternion::about(normalized(shape.rotate_axis) * angle)};
}

/// A collider as Bullet knows it: a form, and where it stands in the collider.
struct Form {
  std::unique_ptr<btTriangleMesh> triangles;
  std::unique_ptr<btCollisionShape> shape;
  Pose placement;
};

Form form_of(const CollisionShape& collision, bool rigid, double length) {
  Form form;
  form.placement = placement(collision.shape);
  if (const auto* box = std::get_if<BoxShape>(&collision.shape.form)) {
    form.shape = std::make_unique<btBoxShape>(bullet(box->size * 0.5));
  } else if (const auto* sphere = std::get_if<SphereShape>(&collision.shape.form)) {
    form.shape = std::make_unique<btSphereShape>(sphere->radius);
    return form;  // its margin is its radius
  } else if (const auto* cylinder = std::get_if<CylinderShape>(&collision.shape.form)) {
    form.shape = std::make_unique<btCylinderShape>(btVector3(cylinder->radius, cylinder->height / 2, cylinder->radius));
  } else if (const auto* plane = std::get_if<PlaneShape>(&collision.shape.form)) {
    const Vec3d n = normalized(plane->normal);
    form.shape = std::make_unique<btStaticPlaneShape>(bullet(n), dot(n, plane->point));
    form.placement = {};
  } else {
    form.placement = {};
    const TriMesh& mesh = *collision.mesh;
    if (rigid) {
      auto hull = std::make_unique<btConvexHullShape>();
      for (const Vec3f& v : mesh.vertices) hull->addPoint(bullet(static_cast<Vec3d>(v)), false);
      hull->recalcLocalAabb();
      form.shape = std::move(hull);
    } else {
      form.triangles = std::make_unique<btTriangleMesh>();
      for (const auto& t : mesh.triangles)
        form.triangles->addTriangle(bullet(static_cast<Vec3d>(mesh.vertices[t[0]])),
                                    bullet(static_cast<Vec3d>(mesh.vertices[t[1]])),
                                    bullet(static_cast<Vec3d>(mesh.vertices[t[2]])));
      form.shape = std::make_unique<btBvhTriangleMeshShape>(form.triangles.get(), true);
    }
  }
  form.shape->setMargin(margin * length);
  return form;
}

/// The axes of a body about which its inertia is three numbers.
struct Principal {
  Quaternion axes;
  Vec3d moments;
};
Principal principal(const Mat3d& inertia) {
  Eigen::Matrix3d m;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) m(i, j) = inertia(i, j);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(m);
  Eigen::Matrix3d axes = solver.eigenvectors();
  if (axes.determinant() < 0) axes.col(0) *= -1;
  const Eigen::Quaterniond q(axes);
  const Eigen::Vector3d e = solver.eigenvalues();
  return {{q.w(), q.x(), q.y(), q.z()}, {e.x(), e.y(), e.z()}};
}

constexpr int pool_size = 64;

/// `a` after `b`.
Pose together(const Pose& a, const Pose& b) { return {a(b.position), a.rotation * b.rotation}; }
Pose inverse_of(const Pose& p) { return {p.rotation.inverse()(p.position * -1.0), p.rotation.inverse()}; }

class BulletContacts final : public BodyContacts {
 public:
  BulletContacts(const std::vector<CollisionShape>& shapes, const std::vector<BodyWall>& walls, double length)
      : shapes_(shapes), walls_(walls), length_(length) {}

  void resolve(std::vector<Collider>& colliders, const std::vector<RigidBody>& bodies, double dt) override {
    if (forms_.empty()) make_forms(colliders.size(), bodies);
    // Bullet's own pools hold 4,096 contacts, which take longer to lay out than a few
    // bodies to resolve. What does not fit is allocated.
    btDefaultCollisionConstructionInfo pools;
    pools.m_defaultMaxPersistentManifoldPoolSize = pools.m_defaultMaxCollisionAlgorithmPoolSize = pool_size;
    btDefaultCollisionConfiguration configuration(pools);
    // Bullet finds one point of a face a step, and keeps the others from the steps before; here
    // there are none.
    configuration.setPlaneConvexMultipointIterations(face_points, face_points);
    configuration.setConvexConvexMultipointIterations(face_points, face_points);
    btCollisionDispatcher dispatcher(&configuration);
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld space(&dispatcher, &broadphase, &solver, &configuration);
    space.setGravity({0, 0, 0});
    btContactSolverInfo& settings = space.getSolverInfo();
    settings.m_solverMode &= ~SOLVER_RANDMIZE_ORDER;
    settings.m_splitImpulse = false;
    settings.m_numIterations = iterations;
    settings.m_erp = settings.m_erp2 = push_apart;

    std::deque<btRigidBody> all;
    std::vector<btRigidBody*> of_body(bodies.size());
    for (std::size_t c = 0; c < colliders.size(); ++c) {
      if (!shapes_[c].obstacle) continue;
      const auto found =
          std::find_if(bodies.begin(), bodies.end(), [&](const RigidBody& b) { return b.collider == c; });
      const Collider& collider = colliders[c];
      if (found == bodies.end()) {
        btRigidBody& body =
            all.emplace_back(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, forms_[c].shape.get(), {0, 0, 0}));
        place(body, together(collider.pose, forms_[c].placement), collider);
        if (collider.moves()) body.setCollisionFlags(body.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
        space.addRigidBody(&body);
        continue;
      }
      const auto number = static_cast<std::size_t>(found - bodies.begin());
      btRigidBody& body = all.emplace_back(btRigidBody::btRigidBodyConstructionInfo(
          found->mass, nullptr, compounds_[number].get(), bullet(principals_[number].moments)));
      place(body, together(collider.pose, {found->center, principals_[number].axes}), collider);
      body.setRestitution(found->restitution);
      body.setActivationState(DISABLE_DEACTIVATION);
      body.setLinearFactor(free_axes(found->locked, 0));
      body.setAngularFactor(free_axes(found->locked, 3));
      space.addRigidBody(&body);
      of_body[number] = &body;
    }
    for (std::size_t w = 0; w < walls_.size(); ++w) {
      btRigidBody& body =
          all.emplace_back(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, wall_forms_[w].get(), {0, 0, 0}));
      body.setFriction(1);
      body.setRestitution(1);
      space.addRigidBody(&body);
    }
    space.stepSimulation(dt, 0);
    if (touching(dispatcher))
      for (std::size_t b = 0; b < bodies.size(); ++b) {
        Twist& twist = colliders[bodies[b].collider].twist;
        twist.velocity = from_bullet(of_body[b]->getLinearVelocity());
        twist.spin = from_bullet(of_body[b]->getAngularVelocity());
      }
    for (btRigidBody& body : all) space.removeRigidBody(&body);
  }

 private:
  static btVector3 free_axes(const std::array<bool, 6>& locked, std::size_t first) {
    return {locked[first] ? 0.0 : 1.0, locked[first + 1] ? 0.0 : 1.0, locked[first + 2] ? 0.0 : 1.0};
  }
  static void place(btRigidBody& body, const Pose& pose, const Collider& collider) {
    body.setWorldTransform(bullet(pose));
    body.setInterpolationWorldTransform(bullet(pose));
    const Vec3d at = pose.position;
    body.setLinearVelocity(bullet(collider.twist.at(at)));
    body.setAngularVelocity(bullet(collider.twist.spin));
    // Of a pair both are products: a rigid body's own say how it meets what is none.
    body.setFriction(collider.rigid ? collider.friction : 1);
    body.setRestitution(1);
    body.setDamping(0, 0);
  }
  static bool touching(btCollisionDispatcher& dispatcher) {
    for (int m = 0; m < dispatcher.getNumManifolds(); ++m)
      if (dispatcher.getInternalManifoldPointer()[m]->getNumContacts() > 0) return true;
    return false;
  }
  void make_forms(std::size_t count, const std::vector<RigidBody>& bodies) {
    const auto is_rigid = [&](std::size_t c) {
      return std::any_of(bodies.begin(), bodies.end(), [&](const RigidBody& b) { return b.collider == c; });
    };
    for (std::size_t c = 0; c < count; ++c) forms_.push_back(form_of(shapes_[c], is_rigid(c), length_));
    for (const RigidBody& b : bodies) {
      principals_.push_back(principal(b.inertia));
      // Bullet's bodies turn about their origin, and their axes are the principal ones.
      auto compound = std::make_unique<btCompoundShape>();
      const Pose frame{b.center, principals_.back().axes};
      compound->addChildShape(bullet(together(inverse_of(frame), forms_[b.collider].placement)),
                              forms_[b.collider].shape.get());
      compounds_.push_back(std::move(compound));
    }
    for (const BodyWall& w : walls_)
      wall_forms_.push_back(std::make_unique<btStaticPlaneShape>(bullet(w.normal), dot(w.normal, w.point)));
  }

  std::vector<CollisionShape> shapes_;
  std::vector<BodyWall> walls_;
  double length_;
  std::vector<Form> forms_;  ///< by collider
  std::vector<Principal> principals_;
  std::vector<std::unique_ptr<btCompoundShape>> compounds_;  ///< by body
  std::vector<std::unique_ptr<btStaticPlaneShape>> wall_forms_;
};

}  // namespace

std::unique_ptr<BodyContacts> make_bullet_contacts(const std::vector<CollisionShape>& shapes,
                                                   const std::vector<BodyWall>& walls, double length) {
  return std::make_unique<BulletContacts>(shapes, walls, length);
}

template <class R>
std::unique_ptr<BodyContacts> make_body_contacts(const World<R>& world) {
  if (world.rigid.empty()) return nullptr;
  std::vector<BodyWall> walls;
  const Box3d domain = world.domain();
  for (int side = 0; side < 6; ++side) {
    const Wall& wall = world.walls[static_cast<std::size_t>(side)];
    if (wall.type == WallType::open || world.periodic[static_cast<std::size_t>(side / 2)]) continue;
    Vec3d normal{};
    normal[side / 2] = side % 2 == 0 ? 1 : -1;
    walls.push_back({side % 2 == 0 ? domain.min : domain.max, normal});
  }
  return make_bullet_contacts(world.collision, walls, world.dx);
}
template std::unique_ptr<BodyContacts> make_body_contacts(const World<float>&);
template std::unique_ptr<BodyContacts> make_body_contacts(const World<double>&);

}  // namespace dreampm
