#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/base/interrupt.h"
#include "dreampm/base/log.h"
#include "dreampm/base/progress.h"
#include "dreampm/import/point_cloud.h"
#include "dreampm/import/point_file.h"
#include "dreampm/io/ply.h"
#include "dreampm/math/srgb.h"
#include "dreampm/pictures/frames.h"
#include "dreampm/pipeline/loose_clouds.h"
#include "dreampm/pipeline/loose_files.h"
#include "dreampm/pipeline/loose_names.h"
#include "dreampm/surface/carry.h"
#include "dreampm/surface/surface.h"
#include "dreampm/surface/vdb.h"

namespace dreampm {
namespace fs = std::filesystem;
namespace {

MovingCloud read_cloud(const std::string& file) {
  Model model = read_point_file(file);
  if (!model.triangles.empty()) fail_input("{}: is a mesh; dreampm surface wraps particles", file);
  const Vec3d shift = read_ply_shift(file);
  for (Vec3d& p : model.vertices) p += shift;
  return moving_cloud(std::move(model), file);
}

/// What a mesh of a cloud can hold, and whether the cloud has what that is made of.
struct CloudAttribute {
  const char* name;
  const char* made_of;
  bool (*there)(const MovingCloud&);
};
constexpr std::array<CloudAttribute, 3> known_attributes{{
    {"velocity", "velocities", [](const MovingCloud& c) { return !c.velocities.empty(); }},
    {"vorticity", "velocities", [](const MovingCloud& c) { return !c.velocities.empty(); }},
    {"color", "colors", [](const MovingCloud& c) { return !c.colors.empty(); }},
}};

bool wants(const LooseSurfaces& request, std::string_view name) {
  const auto& wanted = request.attributes;
  return std::find(wanted.begin(), wanted.end(), name) != wanted.end();
}

/// Before any file is read.
void check_attributes(const LooseSurfaces& request) {
  const std::vector<std::string> known = cloud_attributes();
  for (auto name = request.attributes.begin(); name != request.attributes.end(); ++name) {
    if (std::find(known.begin(), known.end(), *name) == known.end())
      fail_input("no attribute {}: of files there are {}", *name, fmt::join(known, ", "));
    if (std::find(request.attributes.begin(), name, *name) != name) fail_input("--attributes has {} twice", *name);
  }
}

void check_made_of(const MovingCloud& cloud, const LooseSurfaces& request, const std::string& file) {
  for (const CloudAttribute& a : known_attributes)
    if (wants(request, a.name) && !a.there(cloud))
      fail_input("{}: has no {}, of which attribute {} is made", file, a.made_of, a.name);
}

VertexAttributes attributes_of(const TriMesh& mesh, const MovingCloud& cloud, const SurfaceInput& input,
                               const LooseSurfaces& request) {
  VertexAttributes out;
  const surface::Carriers carriers{input.positions, input.spacing};
  if (wants(request, "color")) {
    std::vector<Vec3f> colors;
    for (const auto& c : cloud.colors) colors.push_back(linear_color(Vec3d{c[0] / 255.0, c[1] / 255.0, c[2] / 255.0}));
    out.push_back(
        {"color", AttributeKind::color, flat(surface::carry_colors(mesh.vertices, carriers, colors, Mixing::opaque))});
  }
  if (wants(request, "vorticity"))
    out.push_back({"vorticity", AttributeKind::vector,
                   flat(surface::carry_vorticity(mesh.vertices, carriers, input.velocities))});
  return out;
}

/// Writes the mesh, or the volume, of a cloud.
void wrap(const MovingCloud& cloud, const LooseSurfaces& request, const fs::path& target) {
  const double spacing = *request.spacing;
  Box3d box;
  for (const Vec3d& p : cloud.points) box.add(p);
  const Vec3d shift = file_shift(box.min, box.max, spacing);
  std::vector<Vec3f> positions, velocities;
  positions.reserve(cloud.points.size()), velocities.reserve(cloud.velocities.size());
  for (const Vec3d& p : cloud.points) positions.push_back(static_cast<Vec3f>(p - shift));
  for (const Vec3d& v : cloud.velocities) velocities.push_back(static_cast<Vec3f>(v));
  SurfaceInput input;
  input.positions = positions, input.velocities = velocities;
  input.spacing = static_cast<float>(spacing);
  SurfaceSettings settings;
  settings.voxel = static_cast<float>(request.voxel * spacing);
  settings.smooth = request.smooth;
  settings.keep_field = request.type == model::SurfaceType::fog;
  SurfaceResult result = reconstruct(input, settings);
  if (result.field) return write_fog_vdb(target, *result.field, shift);
  if (request.type == model::SurfaceType::sdf) return write_level_set_vdb(target, result.mesh, settings.voxel, shift);
  const VertexAttributes attributes = attributes_of(result.mesh, cloud, input, request);
  if (!request.attributes.empty() && !wants(request, "velocity")) result.mesh.velocities.clear();
  write_mesh(target, result.mesh, shift, "in the unit and the axes of its particles", attributes);
}

}  // namespace

std::vector<std::string> cloud_attributes() {
  std::vector<std::string> names;
  for (const CloudAttribute& a : known_attributes) names.emplace_back(a.name);
  return names;
}

std::vector<fs::path> surface_files(const LooseSurfaces& request) {
  const bool volume = request.type != model::SurfaceType::mesh;
  if (volume && !request.attributes.empty())
    fail_input("--attributes are of the vertices of meshes; --type {} has none",
               request.type == model::SurfaceType::fog ? "fog" : "sdf");
  const std::vector<fs::path> names = loose_names(request.files, request.out, volume ? ".vdb" : ".ply");
  check_attributes(request);
  if (!request.spacing || !(*request.spacing > 0))
    check_spacing(request.spacing, read_cloud(request.files[0]).points, request.files[0]);
  Progress progress("surface: file", names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (interrupted()) throw Interrupted(fmt::format("surface: interrupted before {}", request.files[i]));
    progress.update(i);
    const MovingCloud cloud = read_cloud(request.files[i]);
    check_extent(cloud.points, *request.spacing, request.files[i]);
    if (i == 0)
      for (const std::string& w : cloud_warnings(cloud.points, *request.spacing, request.files[i])) warn("{}", w);
    check_made_of(cloud, request, request.files[i]);
    make_folder(request.out);
    wrap(cloud, request, names[i]);
  }
  progress.update(names.size());
  return names;
}

}  // namespace dreampm
