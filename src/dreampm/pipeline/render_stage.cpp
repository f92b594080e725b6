#include "dreampm/pipeline/render_stage.h"

#include <algorithm>
#include <cmath>

#include "dreampm/base/error.h"
#include "dreampm/base/hash.h"
#include "dreampm/base/log.h"
#include "dreampm/io/numbered.h"
#include "dreampm/io/ply.h"
#include "dreampm/pictures/draw.h"
#include "dreampm/pipeline/foam_stage.h"
#include "dreampm/pipeline/surface_stage.h"
#include "dreampm/scene/emit.h"

namespace dreampm {
namespace fs = std::filesystem;
namespace {

Image draw(const RunFolder& run, int number, const RenderSettings& settings, const DrawnColliders& colliders) {
  std::optional<ParticleFrame> particles;
  FrameContent content;
  content.particles = [&]() -> const ParticleFrame& {
    if (!particles) particles = read_particles(run.particles(number));
    return *particles;
  };
  content.mesh = [&](int material) { return read_mesh(surface_file(run, material, number)); };
  content.foam = [&] { return read_foam(foam_file(run, number)).particles; };
  return draw_frame(run.scene, run.record.shift, run.record.bodies, content, colliders, settings);
}

void check_surfaces(const RunFolder& run, const std::vector<int>& frames) {
  if (const std::string why = no_foam(run, frames); !why.empty()) fail_input("{}", why);
  if (meshed_materials(run.scene).empty()) return;
  if (const std::string why = no_surface(run, frames); !why.empty()) fail_input("{}", why);
}

}  // namespace

RenderSettings scaled(RenderSettings settings, double scale, const std::optional<int>& samples) {
  if (!(scale > 0 && scale <= 4)) fail_input("scale is {}: must be above 0 and at most 4", scale);
  if (samples && *samples < 2) fail_input("samples is {}: must be 2 or more", *samples);
  // The encoder wants even sides.
  for (int* const side : {&settings.width, &settings.height})
    *side = std::max(8, 2 * static_cast<int>(std::lround(*side * scale / 2)));
  settings.samples = samples.value_or(settings.samples);
  settings.min_samples = std::min(settings.min_samples, settings.samples);
  return settings;
}

fs::path picture_file(const RunFolder& run, int frame) {
  return run.folder / "render" / numbered("render", frame, ".png");
}

std::function<Identity(int frame)> render_identity(const RunFolder& run, const RenderOptions& options) {
  const RenderSettings s = scaled(render_settings(run.scene), options.scale, options.samples);
  Hash64 own;
  own.add(std::string_view(scene::scene_hash(run.scene, scene::Part::render, run.record.scene_hash)));
  own.add(s.width), own.add(s.height), own.add(s.samples);
  return [surface = surface_identity(run), foam = foam_identity(run), hash = own.hex()](int frame) {
    Identity identity = surface(frame);
    for (auto& named : foam(frame)) identity.push_back(std::move(named));
    identity.emplace_back("render settings", hash);
    return identity;
  };
}

std::string no_picture(const RunFolder& run, const std::vector<int>& frames) {
  return not_up_to_date(run, "render", frames, render_identity(run));
}

StageResult render_stage(RunFolder& run, const RenderOptions& options) {
  const RenderSettings settings = scaled(render_settings(run.scene), options.scale, options.samples);
  StageWork work;
  work.name = "render";
  work.settings_hash = scene::scene_hash(run.scene, scene::Part::render, run.record.scene_hash);
  work.frames = run.chosen(options.first, options.last);
  work.all_frames = options.first == 0 && options.last == 0;
  work.identity = render_identity(run, options);
  work.products = [&](int f) { return std::vector<fs::path>{picture_file(run, f)}; };
  std::optional<ColliderModels> colliders;  // made when the first picture asks for them
  work.make = [&](int f) {
    if (!colliders) colliders.emplace(run.scene, run.record.shift);
    const FrameRecord& frame = run.frame_record(f);
    write_png(picture_file(run, f), draw(run, f, settings, colliders->at(colliders->poses_in(frame), frame.time)));
  };
  check_surfaces(run, work.frames);
  return run_stage(run, work);
}

}  // namespace dreampm
