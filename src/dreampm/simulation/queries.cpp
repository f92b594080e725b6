#include "dreampm/queries.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "dreampm/base/error.h"
#include "dreampm/simulation.h"

namespace dreampm {
namespace {

/// The part of a ray from `origin` along a unit vector that is in a box [m]; empty: it misses.
struct Part {
  double from, to;
  bool empty() const { return !(from <= to); }
};
Part part_in(const Box3d& box, const Vec3d& origin, const Vec3d& along, double longest) {
  Part part{0, longest};
  for (int a = 0; a < 3; ++a) {
    if (along[a] == 0) {
      if (origin[a] < box.min[a] || origin[a] > box.max[a]) return {0, -1};
      continue;
    }
    const double low = (box.min[a] - origin[a]) / along[a], high = (box.max[a] - origin[a]) / along[a];
    part = {std::max(part.from, std::min(low, high)), std::min(part.to, std::max(low, high))};
  }
  return part;
}

/// Goes on by how far the nearest surface is, until that is a hair.
void meet_colliders(const Simulation& simulation, const Vec3d& origin, const Vec3d& along, const Part& part,
                    std::optional<RayHit>& first) {
  constexpr int most_looks = 10000;
  const double hair = 1e-4 * simulation.scene().spacing();
  const std::vector<ColliderShape> shapes = simulation.collider_shapes();
  if (shapes.empty()) return;
  double way = part.from;
  for (int n = 0; n < most_looks && way <= part.to; ++n) {
    const Vec3d at = origin + along * way;
    const ColliderShape* nearest = nullptr;
    double near = 0;
    for (const ColliderShape& shape : shapes)
      if (const double d = shape.distance(at); !nearest || d < near) nearest = &shape, near = d;
    if (near < hair) {
      first = RayHit{way, at, nearest->name(), {}};
      return;
    }
    way += near;
  }
}

void meet_particles(const Simulation& simulation, const Vec3d& origin, const Vec3d& along, const Part& part,
                    std::optional<RayHit>& first) {
  const double radius = 0.5 * simulation.scene().spacing(), radius2 = radius * radius;
  for (const std::string& material : simulation.scene().materials())
    simulation.visit(material, {.id = true}, [&](const ParticleBatch& some) {
      for (std::size_t i = 0; i < some.size(); ++i) {
        const Vec3d to = some.position[i] - origin;
        const double middle = dot(to, along), off2 = length2(to) - middle * middle;
        if (off2 > radius2 || length2(to) <= radius2) continue;
        const double way = middle - std::sqrt(radius2 - off2);
        if (way < part.from || way > part.to || (first && way >= first->distance)) continue;
        first = RayHit{way, origin + along * way, material, some.id[i]};
      }
    });
}

}  // namespace

std::optional<RayHit> cast_ray(const Simulation& simulation, const Vec3d& origin, const Vec3d& direction,
                               double longest) {
  if (!is_finite(origin) || !is_finite(direction) || !(length(direction) > 0) || std::isnan(longest))
    fail_input("cast_ray: origin and direction must be finite, the direction not zero, and longest a number");
  const Vec3d along = normalized(direction);
  const Part part = part_in({simulation.scene().min(), simulation.scene().max()}, origin, along, longest);
  std::optional<RayHit> first;
  if (part.empty()) return first;
  meet_colliders(simulation, origin, along, part, first);
  meet_particles(simulation, origin, along, part, first);
  return first;
}

std::vector<NearCollider> colliders_near(const Simulation& simulation, const Vec3d& point, double distance) {
  std::vector<NearCollider> near;
  for (const ColliderShape& shape : simulation.collider_shapes())
    if (const double d = shape.distance(point); d < distance) near.push_back({shape.name(), d, shape.is_rigid()});
  return near;
}

std::vector<Contact> contacts(const Simulation& simulation, std::string_view collider, std::optional<double> distance) {
  const ColliderShape shape = simulation.collider_shape(collider);
  const double near = distance.value_or(simulation.scene().spacing());
  const Vec3d around{near, near, near};
  const Box3d bounds = shape.bounds(), reach{bounds.min - around, bounds.max + around};
  std::vector<Contact> all;
  for (const std::string& material : simulation.scene().materials()) {
    Contact contact{material};
    simulation.visit(material, {}, [&](const ParticleBatch& some) {
      for (const Vec3d& x : some.position)
        if (reach.contains(x) && shape.distance(x) < near) ++contact.particles, contact.middle += x;
    });
    if (contact.particles == 0) continue;
    contact.middle = contact.middle / static_cast<double>(contact.particles);
    all.push_back(std::move(contact));
  }
  return all;
}

}  // namespace dreampm
