#include "dreampm/render/intersect.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "dreampm/base/error.h"
#include "dreampm/base/parallel.h"
#include "dreampm/render/color.h"
#include "dreampm/render/embree.h"
#include "dreampm/render/traced_shape.h"

namespace dreampm::trace {

Geometry::Geometry(const RenderScene& scene)
    : embree_(std::make_unique<EmbreeScene>()),
      basin_(scene.basin),
      bounds_(scene.basin),
      is_wall_(scene.is_wall),
      has_floor_(scene.stage.floor == model::Floor::tiles),
      has_glass_(scene.stage.basin == model::Basin::glass),
      floor_y_(scene.basin.min.y),
      open_(static_cast<float>(scene.camera.shutter * scene.frame_time)) {
  const Vec3f size = basin_.size();
  scale_ = std::max(size.x, size.z);
  epsilon_ = 1e-5f * std::max({1.0f, largest(size), std::fabs(largest(basin_.max)), std::fabs(largest(-basin_.min))});
  embree_->device = rtcNewDevice(("threads=" + std::to_string(thread_count())).c_str());
  if (embree_->device == nullptr)
    fail_run("Embree found no device: error {}", static_cast<int>(rtcGetDeviceError(nullptr)));
  embree_->scene = rtcNewScene(embree_->device);
  for (const RenderObject& o : scene.objects) {
    looks_.push_back(traced(o.look));
    interiors_.push_back(looks_.back()->interior());
    fields_.push_back(interiors_.back() != nullptr && !interiors_.back()->scatters ? o.absorption : nullptr);
    colors_.push_back(looks_.back()->color());
    frames_.push_back(o.frame);
    const int index = static_cast<int>(looks_.size()) - 1;
    if (const auto* mesh = std::get_if<const TriMesh*>(&o.form)) add_mesh(**mesh, o, index);
    if (const auto* spheres = std::get_if<RenderSpheres>(&o.form)) add_spheres(*spheres, index);
    if (const auto* grains = std::get_if<RenderGrains>(&o.form)) add_grains(*grains, index);
  }
  std::vector<int> order(looks_.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&](int i) { return scene.objects[static_cast<std::size_t>(i)].priority; });
  ranks_.resize(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) ranks_[static_cast<std::size_t>(order[k])] = static_cast<int>(k);
  if (has_glass_) add_bars();
  rtcCommitScene(embree_->scene);
  embree_->check("building the tree of the scene");
  bounds_.add(bounds_.min - Vec3f{1, 1, 1} * (2 * epsilon_));
  bounds_.add(bounds_.max + Vec3f{1, 1, 1} * (2 * epsilon_));
}

Geometry::~Geometry() = default;

bool Geometry::meets_bounds(const Vec3f& o, const Vec3f& d) const {
  float near = 0, far = 1e9f;
  for (int k = 0; k < 3; ++k) {
    const float inverse = 1 / d[k];
    float a = (bounds_.min[k] - o[k]) * inverse, b = (bounds_.max[k] - o[k]) * inverse;
    if (a > b) std::swap(a, b);
    if (a > near) near = a;  // written so that the 0/0 of a ray in a plane keeps the old value
    if (b < far) far = b;
  }
  return near <= far;
}

Vec3f Geometry::velocity(const Hit& hit) const {
  return hit.shape == no_shape ? Vec3f{} : shapes_[hit.shape].velocity(hit.primitive, hit.u, hit.v);
}

Hit Geometry::cast(const Vec3f& o, const Vec3f& d, int medium, float time, float reach, PassedGrains* passed) const {
  const Hit hit = first_of(o, d, medium, time, reach, passed);
  if (passed != nullptr) {
    for (std::size_t i = 0; i < passed->count; ++i)
      if (passed->met[i].t < hit.t) passed->left *= passed->met[i].left;
    passed->count = 0;
  }
  return hit;
}

Hit Geometry::first_of(const Vec3f& o, const Vec3f& d, int medium, float time, float reach,
                       PassedGrains* passed) const {
  Hit hit;
  hit.t = reach;
  int wall = 0;
  if (meets_bounds(o, d)) {
    RTCRayHit r{};
    r.ray.org_x = o.x, r.ray.org_y = o.y, r.ray.org_z = o.z;
    r.ray.dir_x = d.x, r.ray.dir_y = d.y, r.ray.dir_z = d.z;
    r.ray.tnear = epsilon_, r.ray.tfar = reach;
    r.ray.mask = ~0u, r.ray.time = time;
    r.hit.geomID = r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    first_hit(embree_->scene, r, passed);
    if (r.hit.geomID != RTC_INVALID_GEOMETRY_ID) {
      const TracedShape& shape = shapes_[r.hit.geomID];
      const std::size_t primitive = r.hit.primID;
      hit.t = r.ray.tfar;
      hit.kind = shape.kind;
      hit.object = shape.object;
      hit.shape = r.hit.geomID, hit.primitive = r.hit.primID, hit.u = r.hit.u, hit.v = r.hit.v;
      hit.normal = hit.geometric = normalized(Vec3f{r.hit.Ng_x, r.hit.Ng_y, r.hit.Ng_z});
      hit.back = dot(hit.geometric, d) > 0;
      if (shape.kind == Kind::opaque)
        hit.color = shape.color(colors_[static_cast<std::size_t>(shape.object)], primitive, r.hit.u, r.hit.v);
      if (!shape.walls.empty()) wall = shape.walls[primitive];
      if (!shape.opacity.empty()) {
        hit.grain = shape.radii[primitive], hit.opacity = shape.opacity[primitive],
        hit.center = shape.centers[primitive];
        if (!shape.velocities.empty()) hit.center += shape.velocities[primitive] * ((time - 0.5f) * open_);
        hit.normal = hit.geometric = -d, hit.back = false;
      }
      if (!shape.normals.empty() && wall == 0) {
        const Vec3f n = normalized(shape.normal(primitive, r.hit.u, r.hit.v, time));
        if (dot(n, d) * dot(hit.geometric, d) > 0) hit.normal = n;  // else it would face the other way
      }
      // Clear matter has no pattern that would move with it.
      if (!shape.steps.empty() && shape.kind == Kind::opaque)
        hit.moved = shape.moved(primitive, r.hit.u, r.hit.v, time);
      if (wall == 3 && has_floor_) hit.kind = Kind::floor;  // y_min
      hit.glass = has_glass_ && wall != 0 && wall != 3 && wall != 4;
    }
    if (has_glass_ && medium == air) cast_panes(o, d, hit, wall);
  }
  if (has_floor_ && d.y < 0 && hit.kind != Kind::floor) {
    const float t = std::max(0.0f, (floor_y_ - o.y) / d.y);
    // in water the mesh's own bottom comes first unless it is missing there
    if (t < hit.t - (medium == air ? 0 : 10 * epsilon_)) {
      hit = {};
      hit.t = t;
      hit.kind = Kind::floor;
      hit.normal = hit.geometric = {0, 1, 0};
      hit.back = medium != air;
      hit.object = medium;
    }
  }
  return hit;
}

void Geometry::cast_panes(const Vec3f& o, const Vec3f& d, Hit& hit, int wall) const {
  for (const int w : {0, 1, 4, 5}) {
    const int axis = w / 2, side = 2 - axis;
    if (!is_wall_[static_cast<std::size_t>(w)] || std::fabs(d[axis]) < 1e-7f) continue;
    if (hit.kind == Kind::dielectric && wall == 1 + w) continue;  // that face is the pane
    const float t = ((w % 2 == 0 ? basin_.min[axis] : basin_.max[axis]) - o[axis]) / d[axis];
    if (t < 2 * epsilon_ || t >= hit.t) continue;
    const Vec3f p = o + d * t;
    if (p.y < floor_y_ || p.y > basin_.max.y || p[side] < basin_.min[side] || p[side] > basin_.max[side]) continue;
    hit = {};
    hit.t = t;
    hit.kind = Kind::pane;
    hit.normal[axis] = d[axis] > 0 ? -1.0f : 1.0f;
    hit.geometric = hit.normal;
    wall = 0;
  }
}

}  // namespace dreampm::trace
