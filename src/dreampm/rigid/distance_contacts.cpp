#include "dreampm/rigid/distance_contacts.h"

#include <array>
#include <new>

#include "dreampm/contact/body_surface.h"
#include "dreampm/geometry/solids/solid.h"
#include "dreampm/rigid/bullet_forms.h"
#include "dreampm/rigid/bullet_vectors.h"

namespace dreampm {
namespace {

/// Contact points of a pair are kept apart by where their normals point: Bullet keeps four of each
/// list, which are enough for a face and too few for what a hollow holds from all sides.
constexpr std::size_t sides = 6;

std::size_t side_of(const btVector3& n) {
  const int axis = n.closestAxis();
  return static_cast<std::size_t>(2 * axis + (n[axis] > 0));
}

class ByDistance final : public btCollisionAlgorithm {
 public:
  ByDistance(const btCollisionAlgorithmConstructionInfo& info, const ContactContext& context)
      : btCollisionAlgorithm(info), context_(context) {}
  ~ByDistance() override {
    for (btPersistentManifold* m : manifolds_)
      if (m) m_dispatcher->releaseManifold(m);
  }

  void processCollision(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b, const btDispatcherInfo&,
                        btManifoldResult* out) override {
    const auto body = [&](const btCollisionObjectWrapper* w) -> const ContactBody& {
      return context_.bodies[static_cast<std::size_t>(w->getCollisionObject()->getUserIndex())];
    };
    // Bullet's normals point from the second to the first.
    for_points(body(a), body(b), [&](const Vec3d& at, const Vec3d& normal, double gap) {
      add(a, b, bullet(at - normal * gap), bullet(normal), gap, *out);
    });
    for_points(body(b), body(a), [&](const Vec3d& at, const Vec3d& normal, double gap) {
      add(a, b, bullet(at), bullet(normal * -1.0), gap, *out);
    });
  }
  btScalar calculateTimeOfImpact(btCollisionObject*, btCollisionObject*, const btDispatcherInfo&,
                                 btManifoldResult*) override {
    return 1;
  }
  void getAllContactManifolds(btManifoldArray& all) override {
    for (btPersistentManifold* m : manifolds_)
      if (m) all.push_back(m);
  }

 private:
  /// `found` gets the points of a body that another collider may meet in the step: where they are
  /// in Bullet's coordinates, the outward normal of the other there, and how far off it is.
  template <class Found>
  void for_points(const ContactBody& body, const ContactBody& other, const Found& found) const {
    if (!body.points) return;
    const Pose &own = body.collider->pose, &there = other.collider->pose;
    const Region& region = *other.collider->shape;
    Box3d bounds = region.bounds();
    const bool ends = is_finite(bounds.min) && is_finite(bounds.max);
    const Vec3d middle = ends ? there(bounds.center()) : Vec3d{};
    const double reach = body.radius + (body.speed + other.speed) * context_.dt + context_.reach;
    bounds.min -= Vec3d{reach, reach, reach}, bounds.max += Vec3d{reach, reach, reach};
    for (const Vec3d& point : *body.points) {
      Vec3d at = own(point);
      if (ends) at += to_nearest(at - middle, context_.period);
      const Vec3d seen = there.inverse(at);
      if (!bounds.contains(seen)) continue;
      const double distance = region.distance(seen);
      if (distance > reach) continue;
      const Vec3d normal = there.rotation(region.normal(seen));
      found(at - normal * body.radius - context_.origin, normal, distance - body.radius);
    }
  }
  void add(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b, const btVector3& on_second,
           const btVector3& normal, double gap, btManifoldResult& out) {
    btPersistentManifold*& manifold = manifolds_[side_of(normal)];
    if (!manifold) manifold = m_dispatcher->getNewManifold(a->getCollisionObject(), b->getCollisionObject());
    out.setPersistentManifold(manifold);
    out.addContactPoint(normal, on_second, gap);
  }

  const ContactContext& context_;
  std::array<btPersistentManifold*, sides> manifolds_{};
};

struct CreateByDistance final : btCollisionAlgorithmCreateFunc {
  const ContactContext& context;

  explicit CreateByDistance(const ContactContext& given) : context(given) {}
  btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                 const btCollisionObjectWrapper*,
                                                 const btCollisionObjectWrapper*) override {
    return new (info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(ByDistance))) ByDistance(info, context);
  }
};

}  // namespace

DistanceConfiguration::DistanceConfiguration(const btDefaultCollisionConstructionInfo& pools,
                                             const ContactContext& context)
    : btDefaultCollisionConfiguration(pools), by_distance_(std::make_unique<CreateByDistance>(context)) {}

btCollisionAlgorithmCreateFunc* DistanceConfiguration::getCollisionAlgorithmCreateFunc(int type0, int type1) {
  const bool any = type0 == CUSTOM_POLYHEDRAL_SHAPE_TYPE || type1 == CUSTOM_POLYHEDRAL_SHAPE_TYPE;
  if (any && type0 != STATIC_PLANE_PROXYTYPE && type1 != STATIC_PLANE_PROXYTYPE) return by_distance_.get();
  return btDefaultCollisionConfiguration::getCollisionAlgorithmCreateFunc(type0, type1);
}

std::vector<Vec3d> corner_points(const CollisionShape& collision, const Vec3d& corner) {
  std::vector<Vec3d> points;
  if (collision.mesh) {
    for (const Vec3f& v : collision.mesh->vertices) points.push_back(static_cast<Vec3d>(v) + corner);
  } else if (const auto solid = solid_of(collision.shape)) {
    const Pose placed = placement_of(collision.shape);
    for (const Vec3d& p : solid->corners()) points.push_back(placed(p));
  }
  return points;
}

std::vector<Vec3d> contact_points(const Collider& collider, const CollisionShape& collision, const Vec3d& corner,
                                  double dx) {
  std::vector<Vec3d> points = corner_points(collision, corner);
  if (!collision.mesh && std::holds_alternative<SphereShape>(collision.shape.form)) return points;
  for (const BodyPoint& p : body_points(collider.shape, dx)) points.push_back(p.at);
  return points;
}

}  // namespace dreampm
