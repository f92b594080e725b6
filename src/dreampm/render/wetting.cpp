#include "dreampm/render/wetting.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dreampm/base/error.h"
#include "dreampm/base/parallel.h"
#include "dreampm/geometry/nearest_on_triangle.h"
#include "dreampm/render/color.h"
#include "dreampm/render/embree.h"

namespace dreampm::trace {
namespace {

/// How far the vertices go into the wall, as a share of the wetting distance; less in thin walls.
constexpr float overlap_share = 0.2f, thin_share = 0.3f;

/// The nearest point of a set of meshes.
class Walls {
 public:
  Walls() : device_(rtcNewDevice(nullptr)) {
    if (device_ == nullptr) fail_run("Embree found no device: error {}", static_cast<int>(rtcGetDeviceError(nullptr)));
    scene_ = rtcNewScene(device_);
  }
  ~Walls() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  Walls(const Walls&) = delete;
  Walls& operator=(const Walls&) = delete;

  void add(const TriMesh& mesh) {
    const RTCGeometry g = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* points =
        rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3f), mesh.vertices.size());
    void* faces = rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, mesh.triangles.size());
    if (points == nullptr || faces == nullptr) fail_run("Embree ran out of memory while reserving a mesh");
    std::ranges::copy(mesh.vertices, static_cast<Vec3f*>(points));
    std::ranges::copy(mesh.triangles, static_cast<std::array<std::uint32_t, 3>*>(faces));
    rtcCommitGeometry(g);
    rtcAttachGeometryByID(scene_, g, static_cast<unsigned>(meshes_.size()));
    rtcReleaseGeometry(g);
    meshes_.push_back(&mesh);
  }
  void commit() {
    rtcCommitScene(scene_);
    if (const RTCError e = rtcGetDeviceError(device_); e != RTC_ERROR_NONE)
      fail_run("Embree failed with error {} while building the tree of the walls", static_cast<int>(e));
  }

  struct Nearest {
    Vec3f point, normal;
    bool found = false;
  };
  /// `above`: only of faces that p is in front of, and not far to the side.
  Nearest nearest(const Vec3f& p, float radius, bool above) const {
    Search search{this, p, above, {}, std::numeric_limits<float>::max()};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    RTCPointQuery query{p.x, p.y, p.z, 0, radius};
    rtcPointQuery(scene_, &query, &context, &Walls::visit, &search);
    return search.best;
  }
  /// How far it is from p along d to the next face, at most `most`.
  float depth(const Vec3f& p, const Vec3f& d, float from, float most) const {
    RTCRayHit r{};
    r.ray.org_x = p.x, r.ray.org_y = p.y, r.ray.org_z = p.z;
    r.ray.dir_x = d.x, r.ray.dir_y = d.y, r.ray.dir_z = d.z;
    r.ray.tnear = from, r.ray.tfar = most;
    r.ray.mask = ~0u;
    r.hit.geomID = r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    first_hit(scene_, r);
    return r.hit.geomID == RTC_INVALID_GEOMETRY_ID ? most : r.ray.tfar;
  }

 private:
  struct Search {
    const Walls* walls;
    Vec3f from;
    bool above;
    Nearest best;
    float distance2;
  };

  static bool visit(RTCPointQueryFunctionArguments* a) {
    auto& s = *static_cast<Search*>(a->userPtr);
    const TriMesh& mesh = *s.walls->meshes_[a->geomID];
    const auto& [i, j, k] = mesh.triangles[a->primID];
    const Vec3f &p = mesh.vertices[i], &q = mesh.vertices[j], &r = mesh.vertices[k];
    const Vec3f w = nearest_weights(s.from, p, q, r), c = p * w.x + q * w.y + r * w.z;
    const float d2 = length2(c - s.from);
    if (!(d2 < s.distance2) || d2 > a->query->radius * a->query->radius) return false;
    const Vec3f normal = normalized(cross(q - p, r - p));
    if (s.above && dot(s.from - c, normal) < 0.6f * std::sqrt(d2)) return false;
    s.distance2 = d2;
    s.best = {c, normal, true};
    a->query->radius = std::sqrt(d2);
    return true;
  }

  RTCDevice device_;
  RTCScene scene_ = nullptr;
  std::vector<const TriMesh*> meshes_;
};

bool is_clear(const RenderObject& o) { return o.look.type == model::LookType::dielectric; }

std::vector<Vec3f> normals_of(const TriMesh& mesh) {
  if (mesh.normals.size() == mesh.vertices.size()) return mesh.normals;
  std::vector<Vec3f> normals(mesh.vertices.size());
  for (const auto& [p, q, r] : mesh.triangles) {
    const Vec3f n = cross(mesh.vertices[q] - mesh.vertices[p], mesh.vertices[r] - mesh.vertices[p]);
    for (const std::uint32_t v : {p, q, r}) normals[v] += n;
  }
  for (Vec3f& n : normals) n = normalized(n);
  return normals;
}

}  // namespace

std::optional<TriMesh> wetted(const RenderScene& scene, const RenderObject& object, float hair) {
  const auto* form = std::get_if<const TriMesh*>(&object.form);
  if (form == nullptr || !(scene.wetting > 0) || !is_clear(object)) return std::nullopt;
  Walls walls;
  bool any = false;
  for (const RenderObject& o : scene.objects)
    if (const auto* wall = std::get_if<const TriMesh*>(&o.form);
        wall != nullptr && is_clear(o) && o.priority > object.priority && !(*wall)->triangles.empty()) {
      walls.add(**wall);
      any = true;
    }
  if (!any) return std::nullopt;
  walls.commit();
  TriMesh mesh = **form;
  const std::vector<Vec3f> normals = normals_of(mesh);
  const float reach = scene.wetting;
  const auto touch = [&](std::size_t v, bool above) {
    Vec3f& x = mesh.vertices[v];
    const Walls::Nearest wall = walls.nearest(x, reach, above);
    if (!wall.found) return;
    const Vec3f way = wall.point - x;
    const float distance = length(way);
    if (dot(way, wall.normal) > 0 && distance > 1e-3f * reach) return;  // it is inside
    const Vec3f to = distance > 1e-3f * reach ? way / distance : -wall.normal;
    const float facing = smoothstep(-0.2f, 0.3f, dot(normals[v], to)), near = 1 - smoothstep(0.6f, 1, distance / reach);
    const float thick = walls.depth(wall.point, to, 0.01f * reach, reach);
    Vec3f move = to * ((distance + std::min(overlap_share * reach, thin_share * thick)) * facing * near);
    for (int w = 0; w < 6; ++w)
      if (const float plane = w % 2 == 0 ? scene.basin.min[w / 2] : scene.basin.max[w / 2];
          scene.is_wall[static_cast<std::size_t>(w)] && std::fabs(x[w / 2] - plane) < hair)
        move[w / 2] = 0;
    x += move;
  };
  parallel_for(mesh.vertices.size(), 1024, [&](std::size_t v) {
    touch(v, false);
    // In a corner two walls or three.
    touch(v, true);
    touch(v, true);
  });
  return mesh;
}

}  // namespace dreampm::trace
