// How far it is to the nearest surface.
#include <algorithm>
#include <cmath>

#include "dreampm/geometry/nearest_on_triangle.h"
#include "dreampm/render/embree.h"
#include "dreampm/render/intersect.h"
#include "dreampm/render/traced_shape.h"

namespace dreampm::trace {

float Geometry::clearance(const Vec3f& p, float most) const {
  if (moves_) return 0;
  struct Search {
    const std::vector<TracedShape>* shapes;
    Vec3f from;
    static bool visit(RTCPointQueryFunctionArguments* a) {
      const auto& search = *static_cast<const Search*>(a->userPtr);
      const TracedShape& shape = (*search.shapes)[a->geomID];
      float near = 0;
      if (shape.points != nullptr) {
        const auto& [i, j, k] = shape.triangles[a->primID];
        const Vec3f &q = shape.points[i], &r = shape.points[j], &s = shape.points[k];
        const Vec3f w = nearest_weights(search.from, q, r, s);
        near = length(q * w.x + r * w.y + s * w.z - search.from);
      } else if (shape.balls != nullptr) {
        const auto& [x, y, z, radius] = shape.balls[a->primID];
        near = std::fabs(length(Vec3f{x, y, z} - search.from) - radius);
      } else {
        near = std::max(0.0f, length(shape.centers[a->primID] - search.from) - shape.radii[a->primID]);
      }
      if (near >= a->query->radius) return false;
      a->query->radius = near;
      return true;
    }
  };
  Search search{&shapes_, p};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  RTCPointQuery query{p.x, p.y, p.z, 0, most};
  rtcPointQuery(embree_->scene, &query, &context, &Search::visit, &search);
  // The walls and the floor are planes beside the tree.
  float near = query.radius;
  if (has_floor_) near = std::min(near, std::fabs(p.y - floor_y_));
  for (int axis = 0; axis < 3; ++axis)
    near = std::min({near, std::fabs(p[axis] - basin_.min[axis]), std::fabs(p[axis] - basin_.max[axis])});
  return near;
}

}  // namespace dreampm::trace
