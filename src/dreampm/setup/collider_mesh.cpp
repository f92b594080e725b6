#include "dreampm/setup/collider_mesh.h"

#include <algorithm>
#include <cmath>

#include "dreampm/base/parallel.h"
#include "dreampm/geometry/solids/facets.h"
#include "dreampm/geometry/solids/solid.h"
#include "dreampm/import/import.h"
#include "dreampm/level_set/level_set.h"
#include "dreampm/level_set/shell.h"
#include "dreampm/math/mat3.h"
#include "dreampm/surface/attributes.h"
#include "dreampm/surface/contour.h"

namespace dreampm {
namespace {

/// A mesh from a file, sized and placed in double, counted from `shift`: its own coordinates may be
/// large.
TriMesh imported(const MeshShape& form, const Shape& shape, const Vec3d& shift) {
  Model model = mesh_of(form);
  const Box3d own = bounds_of(model);
  const Vec3d s = own.size();
  const double factor = form.longest ? *form.longest / std::max({s.x, s.y, s.z}) : form.scale.value_or(1);
  const Vec3d to = shape.center.value_or(own.center() * factor) - shift;
  const Mat3d turn =
      shape.rotate_angle == 0 ? Mat3d::identity() : rotation_about(shape.rotate_axis, shape.rotate_angle);
  for (Vec3d& v : model.vertices) v = turn * ((v - own.center()) * factor) + to;
  return about(model, {});
}

/// About its own center, then to `center`, counted from `shift`.
void place(TriMesh& mesh, const Shape& shape, const Vec3d& shift) {
  Box3d bounds;
  for (const Vec3f& v : mesh.vertices) bounds.add(static_cast<Vec3d>(v));
  const Vec3d own = bounds.center(), to = shape.center.value_or(own) - shift;
  const Mat3d turn =
      shape.rotate_angle == 0 ? Mat3d::identity() : rotation_about(shape.rotate_axis, shape.rotate_angle);
  for (Vec3f& v : mesh.vertices) v = static_cast<Vec3f>(turn * (static_cast<Vec3d>(v) - own) + to);
}

/// The polygon in which the plane through `point` cuts the box.
TriMesh cut(const Vec3d& point, const Vec3d& normal, const Box3d& room, const Vec3d& shift) {
  std::vector<Vec3d> corners;
  for (int axis = 0; axis < 3; ++axis)
    for (int k = 0; k < 4; ++k) {
      Vec3d a, b;
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      a[axis] = room.min[axis], b[axis] = room.max[axis];
      a[u] = b[u] = k & 1 ? room.max[u] : room.min[u];
      a[v] = b[v] = k & 2 ? room.max[v] : room.min[v];
      const double da = dot(a - point, normal), db = dot(b - point, normal);
      if ((da < 0) != (db < 0)) corners.push_back(a + (b - a) * (da / (da - db)));
    }
  TriMesh mesh;
  if (corners.size() < 3) return mesh;
  Vec3d middle{};
  for (const Vec3d& c : corners) middle += c / static_cast<double>(corners.size());
  const Vec3d e = normalized(corners[0] - middle), f = cross(normal, e);
  const auto angle = [&](const Vec3d& c) { return std::atan2(dot(c - middle, f), dot(c - middle, e)); };
  std::sort(corners.begin(), corners.end(), [&](const Vec3d& a, const Vec3d& b) { return angle(a) < angle(b); });
  for (Vec3d& c : corners) c -= shift;
  add_polygon(mesh, corners);
  return mesh;
}

/// Planes reach for ever, and are cut at the room's sides; empty if nothing is left.
Box3d within(Box3d bounds, const Box3d& room) {
  for (int a = 0; a < 3; ++a) {
    bounds.min[a] = std::max(bounds.min[a], room.min[a]);
    bounds.max[a] = std::min(bounds.max[a], room.max[a]);
    if (!(bounds.min[a] < bounds.max[a])) return {};
  }
  return bounds;
}

double longest_side(const Box3d& box) {
  const Vec3d size = box.size();
  return std::max({size.x, size.y, size.z});
}

/// A leaf whose middle is that far outside [voxels] holds no surface.
constexpr double leaf_reach = 9;

TriMesh contoured(const Region& region, double voxel, const Box3d& room, const Vec3d& shift) {
  const Box3d bounds = within(region.bounds(), room);
  if (bounds.empty()) return {};
  const Vec3d size = bounds.size();
  SparseField field;
  field.voxel = static_cast<float>(voxel);
  // 1.5 voxels of margin: the field must end outside.
  const Vec3d origin = bounds.min - Vec3d{1, 1, 1} * (1.5 * voxel);
  field.origin = static_cast<Vec3f>(origin - shift);
  Vec3i leaves;
  for (int a = 0; a < 3; ++a) leaves[a] = static_cast<int>((size[a] / voxel + 4) / SparseField::kWidth) + 1;
  for (int z = 0; z < leaves.z; ++z)
    for (int y = 0; y < leaves.y; ++y)
      for (int x = 0; x < leaves.x; ++x) {
        const Vec3i leaf{x, y, z};
        const Vec3d middle = origin + (static_cast<Vec3d>(leaf * SparseField::kWidth) + Vec3d{3.5, 3.5, 3.5}) * voxel;
        if (region.distance(middle) < leaf_reach * voxel) field.leaves.push_back(leaf);
      }
  field.values.resize(field.leaves.size() * SparseField::kPoints);
  parallel_for(field.leaves.size(), 4, [&](std::size_t l) {
    for (int k = 0; k < SparseField::kPoints; ++k) {
      const Vec3i at = field.leaves[l] * SparseField::kWidth + Vec3i{k & 7, k >> 3 & 7, k >> 6};
      const Vec3d p = origin + static_cast<Vec3d>(at) * voxel;
      double d = region.distance(p);
      // The room's sides close it where it goes on.
      for (int a = 0; a < 3; ++a) d = std::max({d, bounds.min[a] - p[a], p[a] - bounds.max[a]});
      field.leaf(l)[std::size_t(k)] = static_cast<float>(std::clamp(0.5 - d / (4 * voxel), 0.0, 1.0));
    }
  });
  return surface::finish(surface::contour(field, {}));
}

TriMesh drawn_shell(const Shape& shape, double thickness, double voxel, const Box3d& room, const Vec3d& shift) {
  const Meshes meshes(Meshes::Say::log);
  const Box3d bounds = within(make_region(shape, voxel, meshes.boxes())->bounds(), room);
  if (bounds.empty()) return {};
  // Two voxels of a wall leave no cell without a point inside.
  voxel = std::max(std::min(voxel, thickness / 2), longest_side(bounds) / 400);
  thickness = std::max(thickness, 2 * voxel);
  const auto region = shell_region(shape, thickness, thickness / 3, (leaf_reach + 1) * voxel, meshes);
  return contoured(*region, voxel, room, shift);
}

TriMesh drawn(const Shape& shape, double voxel, const Box3d& room, const Vec3d& shift) {
  TriMesh mesh;
  if (const auto solid = solid_of(shape)) mesh = solid->mesh();
  if (const auto* m = std::get_if<MeshShape>(&shape.form)) return imported(*m, shape, shift);
  if (!mesh.vertices.empty()) {
    place(mesh, shape, shift);
    return mesh;
  }
  if (const auto* c = std::get_if<ContainerShape>(&shape.form); c && c->form == ContainerShape::Form::shell)
    voxel = std::min(voxel, c->wall / 2);
  const auto region = make_region(shape, voxel, mesh_regions());
  if (!std::holds_alternative<PlaneShape>(shape.form)) {
    // The voxels of a small object follow from its own edges: a pipe's rim must not be jagged.
    const double longest = longest_side(within(region->bounds(), room));
    return contoured(*region, std::clamp(voxel, longest / 200, longest / 50), room, shift);
  }
  const Vec3d normal = region->normal({});
  return cut(normal * -region->distance({}), normal, room, shift);
}

}  // namespace

TriMesh collider_mesh(const Shape& shape, double voxel, const Box3d& room, const Vec3d& shift,
                      std::optional<double> thickness, bool clear) {
  TriMesh mesh = thickness ? drawn_shell(shape, *thickness, voxel, room, shift) : drawn(shape, voxel, room, shift);
  const Vec3d size = room.size();
  const float hair = 2e-4f * static_cast<float>(std::max({size.x, size.y, size.z}));
  Box3f own;
  for (const Vec3f& v : mesh.vertices) own.add(v);
  for (int a = 0; a < 3; ++a) {
    const float low = static_cast<float>(room.min[a] - shift[a]), high = static_cast<float>(room.max[a] - shift[a]);
    // Not so far that a thin plate would lose its other side.
    const float near = clear ? std::max(hair, std::min(0.5f * static_cast<float>(voxel), 0.25f * own.size()[a])) : hair;
    const float off = clear ? 0 : hair;
    for (Vec3f& v : mesh.vertices) {
      if (std::abs(v[a] - low) < near) v[a] = low + off;
      if (std::abs(v[a] - high) < near) v[a] = high - off;
    }
  }
  return mesh;
}

}  // namespace dreampm
