// PLY and OBJ: a file a frame, by the writers of io/.
#include <fmt/format.h>

#include "dreampm/base/file.h"
#include "dreampm/export/formats.h"
#include "dreampm/io/byte_sink.h"
#include "dreampm/io/numbered.h"

namespace dreampm::exchange {
namespace fs = std::filesystem;
namespace {

/// What a header says of the frame: neither format has a place of its own for it.
std::string note(const ClipInfo& clip, int frame) {
  return fmt::format("{}; frame {}, time {:.9g} s, {:.9g} frames a second", clip.units(), frame, clip.time(frame),
                     clip.fps);
}

/// As vertices, and elements `p` that name them, without which readers drop them.
void write_obj_points(const fs::path& file, const ClipInfo& clip, const ParticleFrame& particles,
                      const std::string& text) {
  replace_file(file, [&](const fs::path& temporary) {
    ByteSink out(temporary, file);
    out.text(fmt::format("# dreampm particles, {}\n", text));
    for (const Vec3f& x : particles.position) out.text(obj_vertex(x, clip.shift));
    for (std::size_t i = 1; i <= particles.size(); ++i) out.text(fmt::format("p {}\n", i));
    out.close();
  });
}

void write_ply_frame(const ClipInfo& clip, const ClipFrame& frame, const fs::path& folder) {
  const std::string text = note(clip, frame.number);
  if (clip.particles) write_particles(folder / numbered("particles", frame.number, ".ply"), frame.particles, text);
  if (clip.foam) write_particles(folder / numbered("foam", frame.number, ".ply"), frame.foam, text);
  for (std::size_t m = 0; m < frame.meshes.size(); ++m)
    write_mesh(folder / numbered(clip.mesh_name(m), frame.number, ".ply"), frame.meshes[m], clip.shift, text,
               frame.attributes_of(m));
  for (std::size_t o = 0; o < clip.objects.size(); ++o)
    write_mesh(folder / numbered(clip.object_name(o), frame.number, ".ply"), placed(clip.objects[o], frame.objects[o]),
               clip.shift, text);
}

void write_obj_frame(const ClipInfo& clip, const ClipFrame& frame, const fs::path& folder) {
  const std::string text = note(clip, frame.number);
  if (clip.particles)
    write_obj_points(folder / numbered("particles", frame.number, ".obj"), clip, frame.particles, text);
  if (clip.foam) write_obj_points(folder / numbered("foam", frame.number, ".obj"), clip, frame.foam, text);
  for (std::size_t m = 0; m < frame.meshes.size(); ++m)
    write_obj(folder / numbered(clip.mesh_name(m), frame.number, ".obj"), frame.meshes[m], clip.shift, text,
              frame.attributes_of(m));
  for (std::size_t o = 0; o < clip.objects.size(); ++o)
    write_obj(folder / numbered(clip.object_name(o), frame.number, ".obj"), placed(clip.objects[o], frame.objects[o]),
              clip.shift, text);
}

}  // namespace

Format ply_format() {
  return {"ply", "particles and meshes, a file a frame", ".ply", false, nullptr, each_frame<write_ply_frame>};
}
Format obj_format() {
  return {"obj", "the same without velocities", ".obj", false, nullptr, each_frame<write_obj_frame>};
}

}  // namespace dreampm::exchange
