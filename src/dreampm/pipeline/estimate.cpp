#include "dreampm/pipeline/estimate.h"

#include <algorithm>
#include <cmath>

#include "dreampm/base/parallel.h"
#include "dreampm/pipeline/surface_stage.h"

namespace dreampm {
namespace {

// Thread-seconds, measured on the preview of two-cubes.
constexpr double surface_per_particle = 5.0e-6;  // at voxel 0.5; grows with the number of voxels on the surface
constexpr double render_per_sample = 2.5e-7;     // a sample of a pixel, where the adaptive sampler stops early
constexpr double render_per_frame = 0.35;        // the floor's light
constexpr double encode_per_pixel = 4.0e-8;
// Bytes of a splash's mesh at voxel 0.5 are this times N^0.75: between a calm surface (2/3) and spray (1). Measured
// over the dragon's preview, 2.9 MB a frame.
constexpr double mesh_bytes = 1050;
// Photons and the floor's light; per byte of a mesh's file its triangles, their search tree and normals. Measured: 41
// MB to draw 2,000 triangles, 113 MB for a picture of 350,000, 105 to 128 MB for whole films of some 100,000.
constexpr double floor_memory = 4e7, memory_per_mesh_byte = 12;
constexpr double picture_bytes_per_pixel = 1.5, film_bytes_per_pixel = 0.1;

}  // namespace

StageEstimate estimate_stages(const SceneDescription& scene, std::size_t particles) {
  const double frames = scene.time.frames, threads = std::max(1, thread_count());
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
  return e;
}

}  // namespace dreampm
