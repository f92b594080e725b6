#include "dreampm/pipeline/render_stage.h"

#include <algorithm>
#include <cmath>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/base/hash.h"
#include "dreampm/base/interrupt.h"
#include "dreampm/base/log.h"
#include "dreampm/base/progress.h"
#include "dreampm/io/numbered.h"
#include "dreampm/io/ply.h"
#include "dreampm/pictures/draw.h"
#include "dreampm/pipeline/foam_stage.h"
#include "dreampm/pipeline/picture_records.h"
#include "dreampm/pipeline/surface_stage.h"
#include "dreampm/pipeline/turntable.h"
#include "dreampm/render/denoise.h"
#include "dreampm/render/picture_exr.h"
#include "dreampm/scene/emit.h"

namespace dreampm {
namespace fs = std::filesystem;
namespace {

const FrameRecord* frame_beside(const RunFolder& run, int frame) {
  for (const FrameRecord& f : run.record.frames)
    if (f.frame == frame) return &f;
  return nullptr;
}

/// Draws frames of a run, whose colliders it makes when the first one asks for them.
class Drawing {
 public:
  explicit Drawing(const RunFolder& run) : run_(run) {}

  Picture draw(int number, const model::Camera& camera, const RenderSettings& settings) {
    if (!colliders_) colliders_.emplace(run_.scene, run_.record.shift);
    std::optional<ParticleFrame> particles;
    FrameContent content;
    content.particles = [&]() -> const ParticleFrame& {
      if (!particles) particles = read_particles(run_.particles(number));
      return *particles;
    };
    content.mesh = [&](int material) { return read_mesh(surface_file(run_, material, number)); };
    content.foam = [&] { return read_foam(foam_file(run_, number)).particles; };
    model::Scene scene = run_.scene;
    scene.render.camera = camera;
    const FrameRecord& frame = run_.frame_record(number);
    // A file with motion vectors has them of whole frames, whatever the shutter.
    const double open = (camera.shutter > 0 ? camera.shutter : settings.surfaces ? 1 : 0) / scene.time.fps;
    const ColliderMotion motion =
        colliders_->motion_about(frame, frame_beside(run_, number - 1), frame_beside(run_, number + 1), open);
    return draw_frame(scene, run_.record.shift, run_.record.bodies, content,
                      colliders_->at(colliders_->poses_in(frame), frame.time, motion), settings);
  }

 private:
  const RunFolder& run_;
  std::optional<ColliderModels> colliders_;
};

void check_surfaces(const RunFolder& run, const std::vector<int>& frames) {
  if (const std::string why = no_foam(run, frames); !why.empty()) fail_input("{}", why);
  if (meshed_materials(run.scene).empty()) return;
  if (const std::string why = no_surface(run, frames); !why.empty()) fail_input("{}", why);
}

}  // namespace

RenderSettings wished(RenderSettings settings, const PictureWishes& wishes) {
  const double scale = wishes.scale;
  if (!(scale > 0 && scale <= 4)) fail_input("scale is {}: must be above 0 and at most 4", scale);
  if (wishes.samples && *wishes.samples < 2) fail_input("samples is {}: must be 2 or more", *wishes.samples);
  // The encoder wants even sides.
  for (int* const side : {&settings.width, &settings.height})
    *side = std::max(8, 2 * static_cast<int>(std::lround(*side * scale / 2)));
  settings.samples = wishes.samples.value_or(settings.samples);
  settings.min_samples = std::min(settings.min_samples, settings.samples);
  settings.surfaces = settings.surfaces || wishes.exr;
  settings.denoise = settings.denoise || wishes.denoise;
  return settings;
}

void write_picture(const fs::path& png, const Picture& picture) {
  if (!picture.surfaces.depth.empty()) write_exr(fs::path(png).replace_extension(".exr"), exr_of(picture));
  write_png(png, tone_map(picture));
}

fs::path picture_file(const RunFolder& run, int frame) {
  return run.folder / "render" / numbered("render", frame, ".png");
}

std::function<Identity(int frame)> render_identity(const RunFolder& run, const RenderOptions& options) {
  const RenderSettings s = wished(render_settings(run.scene), options.wishes);
  Hash64 own;
  own.add(std::string_view(scene::scene_hash(run.scene, scene::Part::render, run.record.scene_hash)));
  own.add(s.width), own.add(s.height), own.add(s.samples), own.add(int(s.denoise));
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
  const RenderSettings settings = wished(render_settings(run.scene), options.wishes);
  if (settings.denoise) check_denoiser();
  StageWork work;
  work.name = "render";
  work.settings_hash = scene::scene_hash(run.scene, scene::Part::render, run.record.scene_hash);
  work.frames = run.chosen(options.first, options.last);
  work.all_frames = options.first == 0 && options.last == 0;
  work.identity = render_identity(run, options);
  const auto exr_file = [&](int f) { return picture_file(run, f).replace_extension(".exr"); };
  work.products = [&](int f) {
    std::vector<fs::path> files{picture_file(run, f)};
    if (settings.surfaces) files.push_back(exr_file(f));
    return files;
  };
  // An OpenEXR file of other settings would stand beside the new picture.
  work.leftovers = [&](int f) { return std::vector<fs::path>{exr_file(f)}; };
  Drawing drawing(run);
  work.make = [&](int f) {
    const Picture picture = drawing.draw(f, run.scene.render.camera, settings);
    write_picture(picture_file(run, f), picture);
    const PictureRecord record{f, picture.report.samples, picture.report.error, picture.report.at_limit};
    enter_picture(run.record.stages["render"].pictures, record);
    info("render: frame {}: {}", f, picture_line(record, settings.samples, double(settings.noise)));
  };
  check_surfaces(run, work.frames);
  if (work.all_frames) keep_pictures(run.record.stages["render"].pictures, work.frames);
  return run_stage(run, work);
}

std::vector<fs::path> render_part(const RunFolder& run, const RenderOptions& options, const PixelBox& part,
                                  const fs::path& out) {
  RenderSettings settings = wished(render_settings(run.scene), options.wishes);
  if (settings.denoise) check_denoiser();
  settings.crop = part;
  check_render(render_scene(run.scene, run.record.shift), settings);
  const std::vector<int> frames = run.chosen(options.first, options.last);
  check_surfaces(run, frames);
  make_folder(out);
  Drawing drawing(run);
  Progress progress("render: frame", frames.size());
  std::vector<fs::path> files;
  for (const int f : frames) {
    if (interrupted()) throw Interrupted(fmt::format("render: interrupted before frame {}", f));
    progress.update(files.size());
    write_picture(files.emplace_back(out / numbered("crop", f, ".png")),
                  drawing.draw(f, run.scene.render.camera, settings));
  }
  progress.update(frames.size());
  return files;
}

std::vector<fs::path> render_turntable(const RunFolder& run, int frame, int pictures, const PictureWishes& wishes,
                                       const fs::path& out) {
  const RenderSettings settings = wished(render_settings(run.scene), wishes);
  if (settings.denoise) check_denoiser();
  run.frame_record(frame);
  check_surfaces(run, {frame});
  const std::vector<model::Camera> cameras =
      turntable(run.scene.render.camera, {run.scene.space.min, run.scene.space.end()},
                static_cast<double>(settings.width) / settings.height, pictures);
  make_folder(out);
  Drawing drawing(run);
  Progress progress("render: picture", cameras.size());
  std::vector<fs::path> files;
  for (const model::Camera& camera : cameras) {
    if (interrupted()) throw Interrupted(fmt::format("render: interrupted before picture {}", files.size() + 1));
    progress.update(files.size());
    const fs::path file = out / numbered("turntable", static_cast<int>(files.size()) + 1, ".png");
    write_picture(files.emplace_back(file), drawing.draw(frame, camera, settings));
  }
  progress.update(cameras.size());
  return files;
}

}  // namespace dreampm
