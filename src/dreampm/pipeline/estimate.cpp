#include "dreampm/pipeline/estimate.h"

#include <algorithm>
#include <cmath>

#include "dreampm/base/error.h"
#include "dreampm/base/parallel.h"
#include "dreampm/pictures/frames.h"
#include "dreampm/pictures/render_scene.h"
#include "dreampm/pipeline/surface_stage.h"
#include "dreampm/scene/attributes.h"
#include "dreampm/setup/start.h"
#include "dreampm/surface/surface.h"

namespace dreampm {
namespace {

// Thread-seconds, measured on the preview of two-cubes.
constexpr double surface_per_particle = 5.0e-6;  // at voxel 0.5; grows with the number of voxels on the surface
constexpr double render_per_sample = 2.5e-7;     // a sample of a pixel, where the adaptive sampler stops early
constexpr double render_per_frame = 0.35;        // the floor's light
constexpr double encode_per_pixel = 4.0e-8;
// Bytes of a splash's mesh at voxel 0.5 are this times N^0.75: between a calm surface (2/3) and
// spray (1). Measured over the dragon's preview, 2.9 MB a frame.
constexpr double mesh_bytes = 1050;
// Photons and the floor's light; per byte of a mesh's file its triangles, their search tree and
// normals. Measured: 41 MB to draw 2,000 triangles, 113 MB for a picture of 350,000, 105 to 128 MB
// for whole films of some 100,000.
constexpr double floor_memory = 4e7, memory_per_mesh_byte = 12;
constexpr double picture_bytes_per_pixel = 1.5, film_bytes_per_pixel = 0.1;

int frames_of(const model::Scene& scene) { return scene.time.frames - first_frame(scene) + 1; }

}  // namespace

StageEstimate estimate_stages(const model::Scene& scene, std::size_t particles) {
  const double frames = frames_of(scene), threads = std::max(1, thread_count());
  const double pixels = double(scene.render.width) * scene.render.height;
  StageEstimate e;
  if (!meshed_materials(scene).empty())
    e.surface_seconds =
        frames * double(particles) * surface_per_particle * std::pow(0.5 / scene.surface.voxel, 2) / threads;
  e.render_seconds = frames * (render_per_frame + pixels * scene.render.samples * render_per_sample) / threads;
  e.video_seconds = frames * pixels * encode_per_pixel;
  double bytes = frames * pixels * (picture_bytes_per_pixel + film_bytes_per_pixel);
  const double mesh = meshed_materials(scene).empty()
                          ? 0
                          : mesh_bytes * std::pow(double(particles), 0.75) * std::pow(0.5 / scene.surface.voxel, 2);
  e.disk_bytes = static_cast<std::uint64_t>(bytes + frames * mesh);
  e.memory_bytes = static_cast<std::uint64_t>(floor_memory + memory_per_mesh_byte * mesh);
  if (scene.foam) e.memory_bytes = std::max(e.memory_bytes, estimate_foam(*scene.foam, particles).memory_bytes);
  return e;
}

FoamEstimate estimate_foam(const model::Foam& foam, std::uint64_t particles) {
  // Two frames of matter and the fields of both; two states of a grain; its row of a file.
  constexpr std::uint64_t a_particle = 300, a_grain = 140, a_row = 41;
  const auto most = static_cast<std::uint64_t>(foam.most);
  return {most, a_particle * particles + a_grain * most, a_row * most};
}

std::size_t particle_file_bytes(const model::Scene& scene) {
  std::size_t bytes = 29;  // place, velocity, id, material
  for (const std::string& a : scene::kept_attributes(scene))
    if (a != "velocity") bytes += a == "f" ? 36 : 4;
  return bytes;
}

std::uint64_t disk_estimate(const model::Scene& scene, std::size_t particles) {
  const auto frames = static_cast<std::uint64_t>(frames_of(scene));
  return frames * particles * particle_file_bytes(scene) + checkpoints_kept * particles * 64 +
         estimate_stages(scene, particles).disk_bytes;
}

std::string disk_shortage(std::uint64_t bytes, const std::filesystem::path& folder) {
  std::error_code unknown;
  const std::uint64_t left = std::filesystem::space(folder, unknown).available;
  if (unknown || bytes <= left) return {};
  return fmt::format("the run will take about {:.0f} MB, but {:.0f} MB are free in {}",
                     1e-6 * static_cast<double>(bytes), 1e-6 * static_cast<double>(left), folder.string());
}

std::vector<std::string> refused_later(const model::Scene& scene) {
  std::vector<std::string> list;
  const Vec3d shift = file_shift(scene.space.min, scene.space.end(), scene.space.spacing);
  RenderScene picture = render_scene(scene, shift);
  for (std::size_t m = 0; m < scene.materials.size(); ++m)
    picture.objects.push_back({RenderSpheres{}, material_look(scene, static_cast<int>(m)), {}});
  for (const model::Collider& c : scene.colliders)
    picture.objects.push_back({RenderSpheres{}, scene.render.looks.at(c.name), {}});
  try {
    check_render(picture, render_settings(scene));
  } catch (const InputError& e) {
    list.push_back(e.what());
  }
  if (meshed_materials(scene).empty()) return list;
  const model::Space& space = scene.space;
  double far = 0;
  for (int a = 0; a < 3; ++a) {
    const auto side = static_cast<std::size_t>(2 * a);
    // Beyond an open wall matter is there for another length of the space.
    const double length = space.end()[a] - space.min[a];
    const double low = space.min[a] - (space.walls[side].type == WallType::open ? length : 0),
                 high = space.end()[a] + (space.walls[side + 1].type == WallType::open ? length : 0);
    far = std::max({far, std::abs(low - shift[a]), std::abs(high - shift[a])});
  }
  if (far > surface_reach * space.spacing)
    list.push_back(
        fmt::format("surface: the space is {:.3g} spacings long with what lies beyond open walls; {:.3g} can be meshed",
                    far / space.spacing, surface_reach));
  return list;
}

}  // namespace dreampm
