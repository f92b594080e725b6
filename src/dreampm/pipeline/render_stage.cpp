#include "dreampm/pipeline/render_stage.h"

#include <algorithm>
#include <cmath>
#include <list>

#include "dreampm/base/error.h"
#include "dreampm/base/hash.h"
#include "dreampm/base/log.h"
#include "dreampm/io/ply.h"
#include "dreampm/pipeline/render_scene.h"
#include "dreampm/pipeline/simulate.h"
#include "dreampm/pipeline/surface_stage.h"
#include "dreampm/scene/emit.h"

namespace dreampm {
namespace fs = std::filesystem;
namespace {

const scene::Look& look_of(const SceneDescription& scene, std::size_t material) {
  return scene.render.looks.at(scene.materials[material].name);
}

RenderSettings settings_of(const SceneDescription& scene, const RenderOptions& options) {
  RenderSettings s = render_settings(scene);
  // The encoder wants even sides.
  const auto side = [&](int n) { return std::max(8, 2 * static_cast<int>(std::lround(n * options.scale / 2))); };
  s.width = side(s.width);
  s.height = side(s.height);
  s.samples = options.samples.value_or(s.samples);
  return s;
}

/// What a frame's picture borrows.
struct Loaded {
  std::list<TriMesh> meshes;
  std::list<std::vector<Vec3f>> arrays;
};

std::vector<Vec3f> positions_of(const SceneDescription& scene, std::size_t material, const ParticleFrame& frame) {
  std::vector<Vec3f> positions;
  for (std::size_t i = 0; i < frame.size(); ++i)
    if (frame.material_names.at(frame.material[i]) == scene.materials[material].name)
      positions.push_back(frame.position[i]);
  return positions;
}

Image draw(const RunFolder& run, int number, const RenderSettings& settings, const DrawnColliders& colliders) {
  const SceneDescription& scene = run.scene;
  RenderScene out = render_scene(scene, run.record.shift);
  out.objects = colliders.objects;
  Loaded loaded;
  std::optional<ParticleFrame> particles;
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    const int material = static_cast<int>(m);
    const scene::Look& look = look_of(scene, m);
    const bool spheres = look.type == scene::LookType::spheres,
               colored = look.type != scene::LookType::dielectric && many_colored(scene, material);
    std::vector<Vec3f>&positions = loaded.arrays.emplace_back(), &colors = loaded.arrays.emplace_back();
    if (spheres || colored) {
      if (!particles) particles = read_particles(run.particles(number));
      positions = positions_of(scene, m, *particles);
      if (colored) colors = particle_colors(scene, material, *particles, run.record.bodies);
    }
    if (spheres) {
      const float radius = static_cast<float>(look.radius * scene.space.spacing);
      if (!positions.empty())
        out.objects.push_back({RenderSpheres{positions, radius, colors}, material_look(scene, material), {}});
      continue;
    }
    const TriMesh& mesh = loaded.meshes.emplace_back(read_mesh(surface_file(run, material, number)));
    if (mesh.triangles.empty()) continue;
    if (colored)
      colors =
          vertex_colors(mesh, positions, colors, static_cast<float>(scene.space.spacing), linear_color(look.color));
    out.objects.push_back({&mesh, material_look(scene, material), colors});
  }
  return render(out, settings);
}

std::vector<int> chosen_frames(const RunFolder& run, const RenderOptions& options) {
  if (options.first == 0 && options.last == 0) return run.frames();
  std::vector<int> list;
  for (int f = options.first; f <= options.last; ++f) {
    run.state_hash(f);  // throws if it is not simulated
    list.push_back(f);
  }
  return list;
}

void check_surfaces(const RunFolder& run, const std::vector<int>& frames) {
  if (meshed_materials(run.scene).empty()) return;
  const FrameTable table(run.folder / "surface" / "frames.csv");
  const auto identity = surface_identity(run);
  for (const int f : frames) {
    const std::string why = table.why_redo(f, identity(f));
    if (!why.empty())
      fail_input("{}: the surface of frame {} is {}; dreampm surface {} makes it", run.folder.string(), f,
                 why == "new" ? "missing" : "not up to date: " + why, run.folder.string());
  }
}

}  // namespace

fs::path picture_file(const RunFolder& run, int frame) {
  return run.folder / "render" / numbered("render", frame, ".png");
}

std::function<Identity(int frame)> render_identity(const RunFolder& run, const RenderOptions& options) {
  const RenderSettings s = settings_of(run.scene, options);
  Hash64 own;
  own.add(std::string_view(scene::scene_hash(run.scene, scene::Part::render, run.record.scene_hash)));
  own.add(s.width), own.add(s.height), own.add(s.samples);
  return [surface = surface_identity(run), hash = own.hex()](int frame) {
    Identity identity = surface(frame);
    identity.emplace_back("render settings", hash);
    return identity;
  };
}

StageResult render_stage(RunFolder& run, const RenderOptions& options) {
  if (!(options.scale > 0 && options.scale <= 4))
    fail_input("scale is {}: must be above 0 and at most 4", options.scale);
  if (options.samples && *options.samples < RenderSettings{}.min_samples)
    fail_input("samples is {}: must be {} or more", *options.samples, RenderSettings{}.min_samples);
  const RenderSettings settings = settings_of(run.scene, options);
  StageWork work;
  work.name = "render";
  work.settings_hash = scene::scene_hash(run.scene, scene::Part::render, run.record.scene_hash);
  work.frames = chosen_frames(run, options);
  work.all_frames = options.first == 0 && options.last == 0;
  work.identity = render_identity(run, options);
  work.products = [&](int f) { return std::vector<fs::path>{picture_file(run, f)}; };
  std::optional<DrawnColliders> colliders;  // made when the first picture asks for them
  work.make = [&](int f) {
    if (!colliders) colliders = drawn_colliders(run.scene, run.record.shift);
    write_png(picture_file(run, f), draw(run, f, settings, *colliders));
  };
  check_surfaces(run, work.frames);
  return run_stage(run, work);
}

}  // namespace dreampm
