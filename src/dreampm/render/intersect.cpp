#include "dreampm/render/intersect.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "dreampm/base/error.h"
#include "dreampm/base/parallel.h"
#include "dreampm/render/color.h"
#include "dreampm/render/embree.h"

namespace dreampm::trace {
namespace {

/// Of a look that is not clear.
Vec3f color_of(const Look& look) {
  return std::visit(
      [](const auto& l) {
        if constexpr (requires { l.color; })
          return l.color;
        else
          return Vec3f{};
      },
      look);
}

}  // namespace

struct Geometry::Embree {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  ~Embree() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }
  void check(const char* doing) const {
    const RTCError e = rtcGetDeviceError(device);
    if (e == RTC_ERROR_OUT_OF_MEMORY) fail_run("Embree ran out of memory while {}", doing);
    if (e != RTC_ERROR_NONE) fail_run("Embree failed with error {} while {}", static_cast<int>(e), doing);
  }
};

struct Geometry::Shape {
  Kind kind = Kind::none;
  int object = air;
  bool spheres = false;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<Vec3f> normals;       ///< per vertex; empty: flat faces
  std::vector<std::uint8_t> walls;  ///< per triangle: 0, or 1 + the wall it lies on
  std::vector<Vec3f> colors;        ///< per sphere or vertex; or empty
  std::vector<float> opacity{};     ///< per grain; of others empty
  std::vector<Vec3f> centers{};     ///< m, per grain, with their radii
  std::vector<float> radii{};

  Vec3f color(const Look& look, std::size_t primitive, float u, float v) const {
    if (colors.empty()) return color_of(look);
    if (spheres) return colors[primitive];
    const auto& [a, b, c] = triangles[primitive];
    return colors[a] * (1 - u - v) + colors[b] * u + colors[c] * v;
  }
};

Geometry::Geometry(const RenderScene& scene)
    : embree_(std::make_unique<Embree>()),
      basin_(scene.basin),
      bounds_(scene.basin),
      is_wall_(scene.is_wall),
      has_floor_(scene.stage.floor == model::Floor::tiles),
      has_glass_(scene.stage.basin == model::Basin::glass),
      floor_y_(scene.basin.min.y) {
  const Vec3f size = basin_.size();
  scale_ = std::max(size.x, size.z);
  epsilon_ = 1e-5f * std::max({1.0f, largest(size), std::fabs(largest(basin_.max)), std::fabs(largest(-basin_.min))});
  embree_->device = rtcNewDevice(("threads=" + std::to_string(thread_count())).c_str());
  if (embree_->device == nullptr)
    fail_run("Embree found no device: error {}", static_cast<int>(rtcGetDeviceError(nullptr)));
  embree_->scene = rtcNewScene(embree_->device);
  for (const RenderObject& o : scene.objects) {
    looks_.push_back(traced(o.look));
    frames_.push_back(o.frame);
    const int index = static_cast<int>(looks_.size()) - 1;
    if (const auto* mesh = std::get_if<const TriMesh*>(&o.form)) add_mesh(**mesh, o.colors, index);
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

void Geometry::add_mesh(const TriMesh& mesh, std::span<const Vec3f> colors, int object) {
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
  Shape shape;
  shape.colors.assign(colors.begin(), colors.end());
  shape.kind = std::holds_alternative<Dielectric>(looks_.back()) ? Kind::dielectric : Kind::opaque;
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
  const RTCGeometry g = rtcNewGeometry(embree_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* points = static_cast<Vec3f*>(
      rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3f), vertices));
  auto* faces = static_cast<std::array<std::uint32_t, 3>*>(
      rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, mesh.triangles.size()));
  if (points == nullptr || faces == nullptr) embree_->check("reserving a mesh");
  std::ranges::copy(mesh.vertices, points);
  std::ranges::copy(mesh.triangles, faces);
  rtcCommitGeometry(g);
  rtcAttachGeometryByID(embree_->scene, g, static_cast<unsigned>(shapes_.size()));
  rtcReleaseGeometry(g);
  shapes_.push_back(std::move(shape));
}

void Geometry::add_spheres(const RenderSpheres& spheres, int object) {
  const std::size_t n = spheres.positions.size();
  if (!(spheres.radius > 0))
    fail_input("render: spheres of radius {} m (object {}); give one above 0", spheres.radius, object);
  if (!spheres.colors.empty() && spheres.colors.size() != n)
    fail_input("render: {} colors for {} spheres (object {}); give one each, or none", spheres.colors.size(), n,
               object);
  if (n == 0) return;
  Shape shape;
  shape.kind = std::holds_alternative<Dielectric>(looks_.back()) ? Kind::dielectric : Kind::opaque;
  shape.object = object;
  shape.spheres = true;
  shape.colors.assign(spheres.colors.begin(), spheres.colors.end());
  const RTCGeometry g = rtcNewGeometry(embree_->device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
  auto* balls = static_cast<std::array<float, 4>*>(
      rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 16, n));
  if (balls == nullptr) embree_->check("reserving spheres");
  const Vec3f reach{spheres.radius, spheres.radius, spheres.radius};
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3f& p = spheres.positions[i];
    if (!is_finite(p)) fail_input("render: sphere {} of object {} is not finite", i, object);
    balls[i] = {p.x, p.y, p.z, spheres.radius};
    bounds_.add(p - reach), bounds_.add(p + reach);
  }
  rtcCommitGeometry(g);
  rtcAttachGeometryByID(embree_->scene, g, static_cast<unsigned>(shapes_.size()));
  rtcReleaseGeometry(g);
  shapes_.push_back(std::move(shape));
}

// Discs that face every ray: one hit each, so that what a ray passes costs no second one.
void Geometry::add_grains(const RenderGrains& grains, int object) {
  const std::size_t n = grains.positions.size();
  if (grains.radii.size() != n || grains.opacity.size() != n || grains.colors.size() != n)
    fail_input("render: {} grains (object {}) with {} radii, {} opacities and {} colors; give one each", n, object,
               grains.radii.size(), grains.opacity.size(), grains.colors.size());
  if (n == 0) return;
  Shape shape;
  shape.kind = Kind::opaque;
  shape.object = object;
  shape.spheres = true;
  shape.colors.assign(grains.colors.begin(), grains.colors.end());
  shape.opacity.assign(grains.opacity.begin(), grains.opacity.end());
  shape.centers.assign(grains.positions.begin(), grains.positions.end());
  shape.radii.assign(grains.radii.begin(), grains.radii.end());
  const RTCGeometry g = rtcNewGeometry(embree_->device, RTC_GEOMETRY_TYPE_DISC_POINT);
  auto* discs = static_cast<std::array<float, 4>*>(
      rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 16, n));
  if (discs == nullptr) embree_->check("reserving grains");
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3f& p = grains.positions[i];
    const float r = grains.radii[i];
    if (!is_finite(p) || !(r > 0) || !std::isfinite(r))
      fail_input("render: grain {} of object {} is not finite, or its radius, {} m, is not above 0", i, object, r);
    discs[i] = {p.x, p.y, p.z, r};
    bounds_.add(p - Vec3f{r, r, r}), bounds_.add(p + Vec3f{r, r, r});
  }
  rtcCommitGeometry(g);
  rtcAttachGeometryByID(embree_->scene, g, static_cast<unsigned>(shapes_.size()));
  rtcReleaseGeometry(g);
  shapes_.push_back(std::move(shape));
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
  std::ranges::copy(points, static_cast<Vec3f*>(rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                        sizeof(Vec3f), points.size())));
  std::ranges::copy(faces, static_cast<std::array<std::uint32_t, 3>*>(rtcSetNewGeometryBuffer(
                               g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, faces.size())));
  rtcCommitGeometry(g);
  rtcAttachGeometryByID(embree_->scene, g, static_cast<unsigned>(shapes_.size()));
  rtcReleaseGeometry(g);
  Shape shape;
  shape.kind = Kind::bar;
  shapes_.push_back(std::move(shape));
}

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

Hit Geometry::cast(const Vec3f& o, const Vec3f& d, int medium) const {
  Hit hit;
  int wall = 0;
  if (meets_bounds(o, d)) {
    RTCRayHit r{};
    r.ray.org_x = o.x, r.ray.org_y = o.y, r.ray.org_z = o.z;
    r.ray.dir_x = d.x, r.ray.dir_y = d.y, r.ray.dir_z = d.z;
    r.ray.tnear = epsilon_, r.ray.tfar = 1e9f;
    r.ray.mask = ~0u;
    r.hit.geomID = r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    first_hit(embree_->scene, r);
    if (r.hit.geomID != RTC_INVALID_GEOMETRY_ID) {
      const Shape& shape = shapes_[r.hit.geomID];
      const std::size_t primitive = r.hit.primID;
      hit.t = r.ray.tfar;
      hit.kind = shape.kind;
      hit.object = shape.object;
      hit.normal = hit.geometric = normalized(Vec3f{r.hit.Ng_x, r.hit.Ng_y, r.hit.Ng_z});
      hit.back = dot(hit.geometric, d) > 0;
      if (shape.kind == Kind::opaque) hit.color = shape.color(look(shape.object), primitive, r.hit.u, r.hit.v);
      if (!shape.walls.empty()) wall = shape.walls[primitive];
      if (!shape.opacity.empty()) {
        hit.grain = shape.radii[primitive], hit.opacity = shape.opacity[primitive],
        hit.center = shape.centers[primitive];
        hit.normal = hit.geometric = -d, hit.back = false;
      }
      if (!shape.normals.empty() && wall == 0) {
        const auto& [p, q, s] = shape.triangles[primitive];
        const Vec3f n = normalized(shape.normals[p] * (1 - r.hit.u - r.hit.v) + shape.normals[q] * r.hit.u +
                                   shape.normals[s] * r.hit.v);
        if (dot(n, d) * dot(hit.geometric, d) > 0) hit.normal = n;  // else it would face the other way
      }
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
