#include "dreampm/rigid/bullet_contacts.h"

#include <btBulletDynamicsCommon.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <deque>

#include "dreampm/rigid/bullet_forms.h"
#include "dreampm/rigid/bullet_vectors.h"
#include "dreampm/rigid/distance_contacts.h"
#include "dreampm/rigid/impacts.h"

namespace dreampm {
namespace {

/// Half of what two bodies may be apart and still touch [cells].
constexpr double margin = 0.02;
/// The part of what two bodies lie within each other that a step pushes apart.
constexpr double push_apart = 0.1;
/// Points of a face to look for at least where two bodies touch.
constexpr int face_points = 4;
/// Iterations over all contacts: stacks of bodies start each step from nothing.
constexpr int iterations = 60;
/// The part of a period beyond which a body has no copies beyond the ends of the axis: what is
/// longer goes round, or nearly.
constexpr double longest_part = 0.5;

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

class BulletContacts final : public BodyContacts {
 public:
  BulletContacts(const std::vector<CollisionShape>& shapes, const BodyRoom& room, const BulletContacts* before)
      : shapes_(shapes), room_(room) {
    if (!before) return;
    kept_ = before->kept_;
    for (std::size_t c = 0; c < before->forms_.size(); ++c)
      if (before->shapes_[c].mesh) kept_.push_back({before->shapes_[c].mesh, before->forms_[c]});
  }

  void resolve(std::vector<Collider>& colliders, const std::vector<RigidBody>& bodies, const std::vector<Twist>& before,
               double dt) override {
    if (forms_.empty()) make_forms(colliders, bodies);
    aim(colliders, bodies, before, dt);
    // Bullet's own pools hold 4,096 contacts, which take longer to lay out than a few
    // bodies to resolve. What does not fit is allocated.
    btDefaultCollisionConstructionInfo pools;
    pools.m_defaultMaxPersistentManifoldPoolSize = pools.m_defaultMaxCollisionAlgorithmPoolSize = pool_size;
    DistanceConfiguration configuration(pools, context_);
    // Bullet finds one point of a face a step, and keeps the others from the steps before; here
    // there are none.
    configuration.setPlaneConvexMultipointIterations(face_points, face_points);
    configuration.setConvexConvexMultipointIterations(face_points, face_points);
    ImpactDispatcher dispatcher(&configuration, context_);
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver solver;
    ImpactWorld space(&dispatcher, &broadphase, &solver, &configuration, context_);
    space.setGravity({0, 0, 0});
    btContactSolverInfo& settings = space.getSolverInfo();
    settings.m_solverMode &= ~SOLVER_RANDMIZE_ORDER;
    settings.m_splitImpulse = false;
    settings.m_numIterations = iterations;
    settings.m_erp = settings.m_erp2 = push_apart;

    std::deque<btRigidBody> all;
    const auto add = [&](std::size_t number, double mass, btCollisionShape* shape, const btVector3& inertia) -> auto& {
      btRigidBody& body = all.emplace_back(btRigidBody::btRigidBodyConstructionInfo(mass, nullptr, shape, inertia));
      body.setUserIndex(static_cast<int>(number));
      body.setFriction(1);
      // The solver has turned spins already.
      body.setFlags(0);
      return body;
    };
    std::vector<btRigidBody*> of_body(bodies.size());
    for (std::size_t c = 0; c < colliders.size(); ++c) {
      if (!shapes_[c].obstacle) continue;
      const auto found =
          std::find_if(bodies.begin(), bodies.end(), [&](const RigidBody& b) { return b.collider == c; });
      const Collider& collider = colliders[c];
      if (found == bodies.end()) {
        for (const Vec3d& shift : copies(collider, c)) {
          btRigidBody& body = add(c, 0, forms_[c]->shape.get(), {0, 0, 0});
          place(body, together(collider.pose, forms_[c]->placement), shift, collider);
          if (collider.moves())
            body.setCollisionFlags(body.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
          space.addRigidBody(&body);
        }
        continue;
      }
      const auto number = static_cast<std::size_t>(found - bodies.begin());
      Form& form = *forms_[c];
      if (!form.by_distance) put_together(number, *found, collider);
      btCollisionShape* const shape = form.by_distance ? form.shape.get() : compounds_[number].get();
      btRigidBody& body = add(c, found->mass, shape, bullet(principals_[number].moments));
      place(body, together(collider.pose, frame_of(number, *found)), {}, collider);
      body.setFriction(collider.friction);
      body.setActivationState(DISABLE_DEACTIVATION);
      body.setLinearFactor(free_axes(found->locked, 0));
      body.setAngularFactor(free_axes(found->locked, 3));
      space.addRigidBody(&body);
      of_body[number] = &body;
    }
    for (std::size_t w = 0; w < wall_forms_.size(); ++w)
      space.addRigidBody(&add(colliders.size() + w, 0, wall_forms_[w].get(), {0, 0, 0}));
    space.stepSimulation(dt, 0);
    const std::vector<bool> touched = touching(dispatcher, context_.bodies.size());
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      if (!of_body[b] || !touched[bodies[b].collider]) continue;
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
  /// Bullet's bodies turn about their origin, and their axes are the principal ones.
  Pose frame_of(std::size_t number, const RigidBody& body) const { return {body.center, principals_[number].axes}; }

  void place(btRigidBody& body, Pose pose, const Vec3d& shift, const Collider& collider) const {
    const Vec3d at = pose.position;
    pose.position += shift - room_.box.min;
    body.setWorldTransform(bullet(pose));
    body.setInterpolationWorldTransform(bullet(pose));
    body.setLinearVelocity(bullet(collider.twist.at(at)));
    body.setAngularVelocity(bullet(collider.twist.spin));
    body.setDamping(0, 0);
  }
  /// Returns for each object true if it has a contact.
  static std::vector<bool> touching(btCollisionDispatcher& dispatcher, std::size_t count) {
    std::vector<bool> touched(count);
    for (int m = 0; m < dispatcher.getNumManifolds(); ++m) {
      const btPersistentManifold& manifold = *dispatcher.getInternalManifoldPointer()[m];
      if (manifold.getNumContacts() == 0) continue;
      for (const btCollisionObject* object : {manifold.getBody0(), manifold.getBody1()})
        touched[static_cast<std::size_t>(object->getUserIndex())] = true;
    }
    return touched;
  }
  /// Along a collider's axes that are periodic, and along which it ends soon enough to have copies.
  Vec3d period_of(const Box3d& bounds) const {
    Vec3d period = room_.period;
    for (int a = 0; a < 3; ++a)
      if (!(bounds.size()[a] <= longest_part * period[a])) period[a] = 0;
    return period;
  }
  /// Shifts [m] at which a collider, or a copy of it beyond a periodic end, reaches into the box.
  std::vector<Vec3d> copies(const Collider& collider, std::size_t c) const {
    std::vector<Vec3d> shifts{{}};
    if (room_.period == Vec3d{} || forms_[c]->by_distance) return shifts;
    const Box3d bounds = collider.bounds();
    const Vec3d period = period_of(bounds);
    for (int a = 0; a < 3; ++a) {
      if (!(period[a] > 0)) continue;
      const double ahead = context_.bodies[c].speed * context_.dt + context_.reach;
      for (std::size_t i = 0, n = shifts.size(); i < n; ++i)
        for (const double side : {-period[a], period[a]}) {
          if (bounds.max[a] + side + ahead < room_.box.min[a] || bounds.min[a] + side - ahead > room_.box.max[a])
            continue;
          Vec3d shift = shifts[i];
          shift[a] += side;
          shifts.push_back(shift);
        }
    }
    return shifts;
  }
  /// A body's form in its frame, with its copies.
  void put_together(std::size_t number, const RigidBody& body, const Collider& collider) {
    auto compound = std::make_unique<btCompoundShape>(false);
    const Pose frame = frame_of(number, body);
    const Form& form = *forms_[body.collider];
    for (const Vec3d& shift : copies(collider, body.collider)) {
      Pose at = together(inverse_of(frame), form.placement);
      at.position += together(collider.pose, frame).rotation.inverse()(shift);
      compound->addChildShape(bullet(at), form.shape.get());
    }
    compounds_[number] = std::move(compound);
  }
  /// Sets the context to the step to come.
  void aim(const std::vector<Collider>& colliders, const std::vector<RigidBody>& bodies,
           const std::vector<Twist>& before, double dt) {
    context_ = {{}, room_.box.min, room_.period, dt, 2 * margin * room_.cell};
    context_.bodies.resize(colliders.size() + wall_forms_.size());
    for (std::size_t c = 0; c < colliders.size(); ++c) {
      const Collider& collider = colliders[c];
      ContactBody& body = context_.bodies[c];
      body.collider = &collider;
      // The fastest point in the coming step; for a collider on a path, at the step's beginning,
      // where it stands.
      body.speed = collider.changing ? collider.fastest(room_.box, collider.time, 0) : 0;
      const Box3d bounds = collider.bounds();
      if (is_finite(bounds.min) && is_finite(bounds.max)) {
        const double away = length(bounds.center() - collider.twist.center) + 0.5 * length(bounds.size());
        body.speed += length(collider.twist.velocity) + length(collider.twist.spin) * away;
      }
      if (!forms_[c]->by_distance) continue;
      auto& shape = static_cast<DistanceShape&>(*forms_[c]->shape);
      const double ahead = body.speed * dt + context_.reach;
      Box3d within{bounds.min - Vec3d{ahead, ahead, ahead}, bounds.max + Vec3d{ahead, ahead, ahead}};
      for (int a = 0; a < 3; ++a)
        if (room_.period[a] > 0 || !(within.size()[a] < 2 * room_.box.size()[a]))
          within.min[a] = room_.box.min[a] - room_.box.size()[a],
          within.max[a] = room_.box.max[a] + room_.box.size()[a];
      shape.least = bullet(within.min - room_.box.min), shape.most = bullet(within.max - room_.box.min);
    }
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      const std::size_t c = bodies[b].collider;
      ContactBody& body = context_.bodies[c];
      body.restitution = bodies[b].restitution, body.before = before[b];
      body.period = period_of(colliders[c].bounds());
    }
    if (any_by_distance_)
      for (std::size_t c = 0; c < colliders.size(); ++c)
        context_.bodies[c].points = &points_[c], context_.bodies[c].radius = radii_[c];
  }
  void make_forms(const std::vector<Collider>& colliders, const std::vector<RigidBody>& bodies) {
    for (std::size_t c = 0; c < colliders.size(); ++c) {
      const auto known =
          std::find_if(kept_.begin(), kept_.end(), [&](const Kept& k) { return k.mesh == shapes_[c].mesh; });
      if (known != kept_.end() && shapes_[c].mesh && !colliders[c].rigid)
        forms_.push_back(known->form);
      else
        forms_.push_back(std::make_shared<Form>(form_of(shapes_[c], colliders[c], margin * room_.cell, room_.box.min)));
      any_by_distance_ = any_by_distance_ || (forms_[c]->by_distance && shapes_[c].obstacle);
    }
    kept_.clear();
    compounds_.resize(bodies.size());
    for (const RigidBody& b : bodies) {
      principals_.push_back(principal(b.inertia));
      const Form& form = *forms_[b.collider];
      const Pose to_frame = inverse_of(frame_of(principals_.size() - 1, b));
      if (form.by_distance) {
        auto& shape = static_cast<DistanceShape&>(*form.shape);
        for (const Vec3d& v : form.hull) shape.addPoint(bullet(to_frame(v)), false);
        shape.recalcLocalAabb();
      }
    }
    if (any_by_distance_)
      for (std::size_t c = 0; c < colliders.size(); ++c) {
        const Vec3d& corner = room_.box.min;
        points_.push_back(colliders[c].rigid      ? contact_points(colliders[c], shapes_[c], corner, room_.cell)
                          : colliders[c].changing ? std::vector<Vec3d>{}
                                                  : corner_points(shapes_[c], corner));
        const auto* ball = std::get_if<SphereShape>(&shapes_[c].shape.form);
        radii_.push_back(ball && !shapes_[c].mesh ? ball->radius : 0);
      }
    for (const BodyWall& w : room_.walls)
      wall_forms_.push_back(
          std::make_unique<btStaticPlaneShape>(bullet(w.normal), dot(w.normal, w.point - room_.box.min)));
  }

  std::vector<CollisionShape> shapes_;
  BodyRoom room_;
  ContactContext context_;
  std::vector<std::shared_ptr<Form>> forms_;  ///< by collider
  /// Forms of meshes, which take the longest to make, until there are forms of all.
  struct Kept {
    std::shared_ptr<const TriMesh> mesh;
    std::shared_ptr<Form> form;
  };
  std::vector<Kept> kept_;
  std::vector<Principal> principals_;
  std::vector<std::unique_ptr<btCompoundShape>> compounds_;  ///< by body
  bool any_by_distance_ = false;
  std::vector<std::vector<Vec3d>> points_;  ///< by collider, where any is met by distance
  std::vector<double> radii_;
  std::vector<std::unique_ptr<btStaticPlaneShape>> wall_forms_;
};

}  // namespace

std::unique_ptr<BodyContacts> make_bullet_contacts(const std::vector<CollisionShape>& shapes, const BodyRoom& room,
                                                   BodyContacts* before) {
  return std::make_unique<BulletContacts>(shapes, room, dynamic_cast<const BulletContacts*>(before));
}

template <class R>
std::unique_ptr<BodyContacts> make_body_contacts(const World<R>& world, BodyContacts* before) {
  if (world.rigid.empty()) return nullptr;
  BodyRoom room{{}, world.domain(), {}, world.dx};
  for (int side = 0; side < 6; ++side) {
    const int axis = side / 2;
    if (world.periodic[static_cast<std::size_t>(axis)]) {
      room.period[axis] = room.box.size()[axis];
      continue;
    }
    if (world.walls[static_cast<std::size_t>(side)].type == WallType::open) continue;
    Vec3d normal{};
    normal[axis] = side % 2 == 0 ? 1 : -1;
    room.walls.push_back({side % 2 == 0 ? room.box.min : room.box.max, normal});
  }
  return make_bullet_contacts(world.collision, room, before);
}
template std::unique_ptr<BodyContacts> make_body_contacts(const World<float>&, BodyContacts*);
template std::unique_ptr<BodyContacts> make_body_contacts(const World<double>&, BodyContacts*);

}  // namespace dreampm
