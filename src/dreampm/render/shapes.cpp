#include <algorithm>
#include <cmath>

#include "dreampm/render/color.h"
#include "dreampm/render/embree.h"
#include "dreampm/render/intersect.h"
#include "dreampm/render/traced_shape.h"

namespace dreampm::trace {
namespace {

std::vector<Vec3f> velocities_of(std::span<const Vec3f> given, std::size_t n, int object) {
  if (!given.empty() && given.size() != n)
    fail_input("render: {} velocities for {} balls (object {}); give one each, or none", given.size(), n, object);
  for (std::size_t i = 0; i < given.size(); ++i)
    if (!is_finite(given[i])) fail_input("render: the velocity of ball {} of object {} is not finite", i, object);
  return {given.begin(), given.end()};
}

/// Where a time lies between even steps: the one before it, and the share of the next.
std::pair<std::size_t, float> step_at(float time, std::size_t steps) {
  const float at = time * static_cast<float>(steps - 1);
  const std::size_t k = std::min(static_cast<std::size_t>(at), steps - 2);
  return {k, at - static_cast<float>(k)};
}

}  // namespace

Vec3f TracedShape::color(const Vec3f& of_look, std::size_t primitive, float u, float v) const {
  if (colors.empty()) return of_look;
  return spheres ? colors[primitive] : mixed(colors, primitive, u, v);
}

Vec3f TracedShape::velocity(std::size_t primitive, float u, float v) const {
  if (velocities.empty()) return {};
  return spheres ? velocities[primitive] : mixed(velocities, primitive, u, v);
}

Vec3f TracedShape::normal(std::size_t primitive, float u, float v, float time) const {
  if (turned.empty()) return mixed(normals, primitive, u, v);
  const auto [k, share] = step_at(time, turned.size());
  return mixed(turned[k], primitive, u, v) * (1 - share) + mixed(turned[k + 1], primitive, u, v) * share;
}

Vec3f TracedShape::moved(std::size_t primitive, float u, float v, float time) const {
  if (steps.empty()) return {};
  const auto at = [&](float t) {
    const auto [k, share] = step_at(t, steps.size());
    return mixed(steps[k], primitive, u, v) * (1 - share) + mixed(steps[k + 1], primitive, u, v) * share;
  };
  return at(time) - at(0.5f);
}

int Geometry::wall_of(const Vec3f& a, const Vec3f& b, const Vec3f& c) const {
  const float near = 2 * epsilon_;
  for (int w = 0; w < 6; ++w) {
    const int axis = w / 2;
    const float plane = w % 2 == 0 ? basin_.min[axis] : basin_.max[axis];
    if (is_wall_[static_cast<std::size_t>(w)] && std::fabs(a[axis] - plane) < near &&
        std::fabs(b[axis] - plane) < near && std::fabs(c[axis] - plane) < near)
      return 1 + w;
  }
  return 0;
}

void Geometry::add_mesh(const TriMesh& mesh, const RenderObject& from, int object) {
  const std::span<const Vec3f> colors = from.colors;
  const std::size_t vertices = mesh.vertices.size();
  if (mesh.triangles.empty()) return;
  for (std::size_t i = 0; i < vertices; ++i)
    if (!is_finite(mesh.vertices[i])) fail_input("render: vertex {} of object {} is not finite", i, object);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (const std::uint32_t v : mesh.triangles[i])
      if (v >= vertices) fail_input("render: triangle {} of object {} names vertex {} of {}", i, object, v, vertices);
  if (!colors.empty() && colors.size() != vertices)
    fail_input("render: {} colors for {} vertices (object {}); give one each, or none", colors.size(), vertices,
               object);
  const bool given = mesh.normals.size() == vertices;
  TracedShape shape;
  shape.colors.assign(colors.begin(), colors.end());
  shape.kind = interiors_.back() != nullptr ? Kind::dielectric : Kind::opaque;
  shape.object = object;
  shape.triangles = mesh.triangles;
  shape.walls.resize(mesh.triangles.size());
  shape.normals.assign(vertices, Vec3f{});
  std::vector<std::uint8_t> touches(vertices);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& [p, q, r] = mesh.triangles[i];
    const Vec3f &a = mesh.vertices[p], &b = mesh.vertices[q], &c = mesh.vertices[r];
    shape.walls[i] = static_cast<std::uint8_t>(shape.kind == Kind::dielectric ? wall_of(a, b, c) : 0);
    for (const std::uint32_t v : {p, q, r}) {
      if (shape.walls[i] != 0)
        touches[v] = 1;
      else  // at a contact line the free surface alone decides
        shape.normals[v] += cross(b - a, c - a);
    }
  }
  for (std::size_t v = 0; v < vertices; ++v) {
    bounds_.add(mesh.vertices[v]);
    shape.normals[v] = normalized(given && touches[v] == 0 ? mesh.normals[v] : shape.normals[v]);
  }
  set_motion(mesh, from, shape, object);
  const RTCGeometry g = rtcNewGeometry(embree_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  const std::size_t steps = std::max<std::size_t>(1, shape.steps.size());
  rtcSetGeometryTimeStepCount(g, static_cast<unsigned>(steps));
  for (std::size_t k = 0; k < steps; ++k) {
    auto* points = static_cast<Vec3f*>(rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, static_cast<unsigned>(k),
                                                               RTC_FORMAT_FLOAT3, sizeof(Vec3f), vertices));
    if (points == nullptr) embree_->check("reserving a mesh");
    std::ranges::copy(shape.steps.empty() ? mesh.vertices : shape.steps[k], points);
    shape.points = points;
  }
  auto* faces = static_cast<std::array<std::uint32_t, 3>*>(
      rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, mesh.triangles.size()));
  if (faces == nullptr) embree_->check("reserving a mesh");
  std::ranges::copy(mesh.triangles, faces);
  attach(g, std::move(shape));
}

void Geometry::attach(RTCGeometryTy* g, TracedShape shape) {
  rtcCommitGeometry(g);
  rtcAttachGeometryByID(embree_->scene, g, static_cast<unsigned>(shapes_.size()));
  rtcReleaseGeometry(g);
  shapes_.push_back(std::move(shape));
}

// Matter on a pane slides along it, and none goes through it.
void Geometry::set_motion(const TriMesh& mesh, const RenderObject& from, TracedShape& shape, int object) {
  const std::size_t n = mesh.vertices.size();
  if (!mesh.velocities.empty() && mesh.velocities.size() != n)
    fail_input("render: {} velocities for {} vertices (object {}); give one each, or none", mesh.velocities.size(), n,
               object);
  shape.velocities = mesh.velocities;
  for (std::size_t i = 0; i < shape.velocities.size(); ++i)
    if (!is_finite(shape.velocities[i]))
      fail_input("render: the velocity of vertex {} of object {} is not finite", i, object);
  if (!(open_ > 0)) return;
  if (!from.motion.empty()) {
    for (const TriMesh* step : from.motion) {
      if (step == nullptr || step->vertices.size() != n || step->triangles != mesh.triangles)
        fail_input("render: a step of the motion of object {} is of other triangles; give the same of each", object);
      shape.steps.push_back(step->vertices);
      if (step->normals.size() == n) shape.turned.push_back(step->normals);
    }
    if (shape.turned.size() != shape.steps.size()) shape.turned.clear();
  } else if (!shape.velocities.empty()) {
    for (const float side : {-0.5f, 0.5f}) {
      std::vector<Vec3f>& points = shape.steps.emplace_back(mesh.vertices);
      for (std::size_t v = 0; v < n; ++v) points[v] = carried(points[v], shape.velocities[v] * (side * open_));
    }
  }
  if (shape.steps.size() == 1) shape.steps.clear(), shape.turned.clear();
  moves_ = moves_ || !shape.steps.empty();
  for (const auto& points : shape.steps)
    for (const Vec3f& p : points) {
      if (!is_finite(p)) fail_input("render: a vertex of a step of the motion of object {} is not finite", object);
      bounds_.add(p);
    }
}

Vec3f Geometry::carried(const Vec3f& p, const Vec3f& way) const {
  const float near = 2 * epsilon_;
  Vec3f to = p + way;
  for (int w = 0; w < 6; ++w) {
    if (!is_wall_[static_cast<std::size_t>(w)]) continue;
    const int axis = w / 2;
    const bool low = w % 2 == 0;
    const float plane = low ? basin_.min[axis] : basin_.max[axis];
    if (std::fabs(p[axis] - plane) < near)
      to[axis] = p[axis];
    else if (low && p[axis] > plane)
      to[axis] = std::max(to[axis], plane + near);
    else if (!low && p[axis] < plane)
      to[axis] = std::min(to[axis], plane - near);
  }
  return to;
}

void Geometry::add_spheres(const RenderSpheres& spheres, int object) {
  const std::size_t n = spheres.positions.size();
  if (!(spheres.radius > 0))
    fail_input("render: spheres of radius {} m (object {}); give one above 0", spheres.radius, object);
  if (!spheres.colors.empty() && spheres.colors.size() != n)
    fail_input("render: {} colors for {} spheres (object {}); give one each, or none", spheres.colors.size(), n,
               object);
  if (n == 0) return;
  TracedShape shape;
  shape.kind = interiors_.back() != nullptr ? Kind::dielectric : Kind::opaque;
  shape.object = object;
  shape.spheres = true;
  shape.colors.assign(spheres.colors.begin(), spheres.colors.end());
  shape.velocities = velocities_of(spheres.velocities, n, object);
  const RTCGeometry g = rtcNewGeometry(embree_->device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
  const float r = spheres.radius;
  for (std::size_t i = 0; i < n; ++i)
    if (!is_finite(spheres.positions[i])) fail_input("render: sphere {} of object {} is not finite", i, object);
  add_points(g, spheres.positions, [r](std::size_t) { return r; }, std::move(shape));
}

template <class Radius>
void Geometry::add_points(RTCGeometryTy* g, std::span<const Vec3f> positions, const Radius& radius, TracedShape shape) {
  const std::size_t n = positions.size();
  const bool moving = open_ > 0 && !shape.velocities.empty();
  rtcSetGeometryTimeStepCount(g, moving ? 2 : 1);
  for (unsigned step = 0; step < (moving ? 2u : 1u); ++step) {
    auto* balls = static_cast<std::array<float, 4>*>(
        rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, step, RTC_FORMAT_FLOAT4, 16, n));
    if (balls == nullptr) embree_->check("reserving spheres");
    if (shape.centers.empty()) shape.balls = balls;
    for (std::size_t i = 0; i < n; ++i) {
      const float r = radius(i);
      const Vec3f p = positions[i] + (moving ? shape.velocities[i] * ((step == 0 ? -0.5f : 0.5f) * open_) : Vec3f{});
      balls[i] = {p.x, p.y, p.z, r};
      bounds_.add(p - Vec3f{r, r, r}), bounds_.add(p + Vec3f{r, r, r});
    }
  }
  moves_ = moves_ || moving;
  attach(g, std::move(shape));
}

// Discs that face every ray: one hit each, so that what a ray passes costs no second one.
void Geometry::add_grains(const RenderGrains& grains, int object) {
  const std::size_t n = grains.positions.size();
  if (grains.radii.size() != n || grains.opacity.size() != n || grains.colors.size() != n)
    fail_input("render: {} grains (object {}) with {} radii, {} opacities and {} colors; give one each", n, object,
               grains.radii.size(), grains.opacity.size(), grains.colors.size());
  if (n == 0) return;
  TracedShape shape;
  shape.kind = Kind::opaque;
  shape.object = object;
  shape.spheres = true;
  shape.colors.assign(grains.colors.begin(), grains.colors.end());
  shape.opacity.assign(grains.opacity.begin(), grains.opacity.end());
  shape.centers.assign(grains.positions.begin(), grains.positions.end());
  shape.radii.assign(grains.radii.begin(), grains.radii.end());
  shape.velocities = velocities_of(grains.velocities, n, object);
  const RTCGeometry g = rtcNewGeometry(embree_->device, RTC_GEOMETRY_TYPE_DISC_POINT);
  has_grains_ = true;
  rtcSetGeometryUserData(g, shape.opacity.data());  // which stays where it is when the shape moves
  rtcSetGeometryIntersectFilterFunction(g, pass_grain);
  for (std::size_t i = 0; i < n; ++i)
    if (const float r = grains.radii[i]; !is_finite(grains.positions[i]) || !(r > 0) || !std::isfinite(r))
      fail_input("render: grain {} of object {} is not finite, or its radius, {} m, is not above 0", i, object, r);
  add_points(g, grains.positions, [&](std::size_t i) { return grains.radii[i]; }, std::move(shape));
}

// The visible edges of the panes: a rim along each wall, a post where two walls meet; just outside
// the wall planes.
void Geometry::add_bars() {
  std::vector<Vec3f> points;
  std::vector<std::array<std::uint32_t, 3>> faces;
  const auto box = [&](const Vec3f& a, const Vec3f& b) {
    const auto first = static_cast<std::uint32_t>(points.size());
    for (int k = 0; k < 8; ++k)
      points.push_back({(k & 1) != 0 ? b.x : a.x, (k & 2) != 0 ? b.y : a.y, (k & 4) != 0 ? b.z : a.z});
    constexpr std::uint32_t sides[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                           {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& s : sides) {
      faces.push_back({first + s[0], first + s[1], first + s[2]});
      faces.push_back({first + s[0], first + s[2], first + s[3]});
    }
    bounds_.add(a), bounds_.add(b);
  };
  const float thick = 0.008f * scale_, rim = 0.004f * scale_, post = 0.6f * thick;
  const Vec3f &lo = basin_.min, &hi = basin_.max;
  const float top = hi.y, under = top - rim;
  const bool x0 = is_wall_[0], x1 = is_wall_[1], z0 = is_wall_[4], z1 = is_wall_[5];
  const float z_first = z0 ? lo.z - thick : lo.z, z_last = z1 ? hi.z + thick : hi.z;
  if (x0) box({lo.x - thick, under, z_first}, {lo.x, top, z_last});
  if (x1) box({hi.x, under, z_first}, {hi.x + thick, top, z_last});
  if (z0) box({lo.x, under, lo.z - thick}, {hi.x, top, lo.z});
  if (z1) box({lo.x, under, hi.z}, {hi.x, top, hi.z + thick});
  for (const bool right : {false, true})
    for (const bool front : {false, true}) {
      if (!(right ? x1 : x0) || !(front ? z1 : z0)) continue;
      const float x = right ? hi.x : lo.x - post, z = front ? hi.z : lo.z - post;
      box({x, floor_y_, z}, {x + post, under - 10 * epsilon_, z + post});
    }
  if (faces.empty()) return;
  const RTCGeometry g = rtcNewGeometry(embree_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* kept = static_cast<Vec3f*>(
      rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3f), points.size()));
  if (kept == nullptr) embree_->check("reserving the edges of the basin");
  std::ranges::copy(points, kept);
  std::ranges::copy(faces, static_cast<std::array<std::uint32_t, 3>*>(rtcSetNewGeometryBuffer(
                               g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, faces.size())));
  TracedShape shape;
  shape.kind = Kind::bar;
  shape.points = kept, shape.triangles = std::move(faces);
  attach(g, std::move(shape));
}

}  // namespace dreampm::trace
