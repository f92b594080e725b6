#include "dreampm/pipeline/export_stage.h"

#include <algorithm>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/base/interrupt.h"
#include "dreampm/base/log.h"
#include "dreampm/base/progress.h"
#include "dreampm/export/material.h"
#include "dreampm/math/camera_view.h"
#include "dreampm/math/srgb.h"
#include "dreampm/pictures/render_scene.h"
#include "dreampm/pipeline/foam_stage.h"
#include "dreampm/pipeline/surface_stage.h"

namespace dreampm {
namespace fs = std::filesystem;
namespace {
using namespace exchange;

/// Where `dreampm render` looks from.
ClipCamera camera_of(const model::Scene& scene, const Axes& axes) {
  const Box3d box{scene.space.min, scene.space.end()};
  const double aspect = static_cast<double>(scene.render.width) / scene.render.height;
  const CameraView view = camera_view(scene.render.camera, box, aspect);
  ClipCamera out{axes.placed(view.eye), axes.turned(view.right), axes.turned(view.up), axes.turned(view.forward)};
  out.fov = view.fov;
  out.aspect = aspect;
  out.far = (length(box.center() - view.eye) + 2 * length(box.size())) * axes.scale;
  return out;
}

/// The materials whose surfaces are exported.
std::vector<int> meshed_of(const RunFolder& run, const ExportOptions& options, const std::vector<int>& frames) {
  if (!options.surface) return {};
  const std::vector<int> meshed = meshed_materials(run.scene);
  if (meshed.empty() && !options.particles)
    fail_input("{}: has no surfaces: every material is drawn as spheres; --what particles exports them",
               run.folder.string());
  const std::string why = no_surface(run, frames);
  if (why.empty() || meshed.empty()) return meshed;
  if (!options.what_there_is) fail_input("{}", why);
  info("particles alone: {}", why);
  return {};
}

/// Materials by the order of the scene, in which the clip names them.
void count_by_scene(ParticleFrame& frame, const ClipInfo& clip, const std::string& file) {
  std::vector<std::uint8_t> number;
  for (const std::string& name : frame.material_names) {
    const auto found = std::find_if(clip.materials.begin(), clip.materials.end(),
                                    [&](const ClipMaterial& m) { return m.name == name; });
    if (found == clip.materials.end()) fail_input("{}: its material {} is not in the run's scene", file, name);
    number.push_back(static_cast<std::uint8_t>(found - clip.materials.begin()));
  }
  for (std::uint8_t& m : frame.material) {
    if (m >= number.size()) fail_input("{}: material {} has no name in its header", file, m);
    m = number[m];
  }
  frame.material_names.clear();
  for (const ClipMaterial& m : clip.materials) frame.material_names.push_back(m.name);
}

/// Of each particle that of its body, or of its material, where the run's files have colors: there
/// a body without one is white.
std::vector<Vec3f> colors_of(const RunFolder& run, const ClipInfo& clip, const ParticleFrame& frame) {
  std::vector<Vec3f> colors;
  if (frame.color.empty()) return colors;
  const MatterColors own_colors(run.scene, run.record.bodies);
  for (std::size_t i = 0; i < frame.size(); ++i) {
    const Vec3f* const own = own_colors.of(frame, i);
    colors.push_back(own ? *own : clip.materials[frame.material[i]].color);
  }
  return colors;
}

/// The scene's colliders and rigid bodies, as a clip has them.
class Objects {
 public:
  /// `frame`: where a wall that was dragged is cut at the sides of the box.
  Objects(const RunFolder& run, const Axes& axes, const FrameRecord& frame)
      : models_(run.scene, run.record.shift), axes_(axes), shift_(axes.placed(run.record.shift)) {
    const std::vector<Pose> poses = models_.poses_in(frame);
    for (std::size_t c = 0; c < models_.size(); ++c) {
      ClipObject o{material_of(models_.name(c), models_.look(c)), models_.mesh_within(c, poses[c]), models_.deforms(c)};
      if (o.mesh.triangles.empty()) continue;  // a pin, or outside of the box
      axes_.apply(o.mesh);
      if (o.deforms) o.mesh = {};
      drawn_.push_back(c), clip_objects_.push_back(std::move(o));
    }
  }
  const std::vector<ClipObject>& list() const { return clip_objects_; }
  std::vector<ObjectState> in(const FrameRecord& frame) const {
    const std::vector<Pose> poses = models_.poses_in(frame);
    std::vector<ObjectState> states;
    for (const std::size_t c : drawn_) {
      ObjectState& state = states.emplace_back();
      state.pose = in_file(poses[c]);
      if (!models_.deforms(c)) continue;
      state.mesh = models_.mesh(c, frame.time);
      axes_.apply(state.mesh);
    }
    return states;
  }

 private:
  /// A pose for places in the axes and unit of the file that count from the shift.
  Pose in_file(const Pose& pose) const {
    if (pose == Pose{}) return {};
    const Quaternion& q = pose.rotation;
    const Vec3d axis = axes_.turned(Vec3d{q.x, q.y, q.z});
    const Quaternion turned{q.w, axis.x, axis.y, axis.z};
    return {axes_.placed(pose.position) + turned(shift_) - shift_, turned};
  }

  ColliderModels models_;
  Axes axes_;
  Vec3d shift_;  ///< in the file
  std::vector<std::size_t> drawn_;
  std::vector<ClipObject> clip_objects_;
};

/// Whether there is foam to be exported.
bool foam_of(const RunFolder& run, const ExportOptions& options, const std::vector<int>& frames) {
  if (!options.foam) return false;
  if (!run.scene.foam) {
    if (!options.particles && !options.surface && !options.colliders)
      fail_input("{}: the scene has no foam", run.folder.string());
    return false;
  }
  const std::string why = no_foam(run, frames);
  if (why.empty()) return true;
  if (!options.what_there_is) fail_input("{}", why);
  info("without foam: {}", why);
  return false;
}

/// Foam as particles of one material, in meters.
ParticleFrame foam_frame(const RunFolder& run, const ClipInfo& clip, int number) {
  FoamFrame foam = read_foam(foam_file(run, number));
  ParticleFrame out;
  out.shift = foam.shift;
  FoamParticles& p = foam.particles;
  out.position = std::move(p.position), out.velocity = std::move(p.velocity), out.id = std::move(p.id);
  out.material.assign(out.size(), 0), out.material_names = {clip.foam_look.name};
  for (float& r : p.radius) r *= static_cast<float>(clip.axes.scale);
  out.columns["age"] = std::move(p.age), out.columns["life"] = std::move(p.life);
  out.columns["radius"] = std::move(p.radius);
  for (const FoamType t : p.type) out.columns["type"].push_back(static_cast<float>(t));
  out.columns["type"].resize(out.size());
  return out;
}

ClipFrame load(const RunFolder& run, const ClipInfo& clip, const std::optional<Objects>& objects, int number) {
  ClipFrame frame;
  frame.number = number;
  if (clip.particles) {
    const fs::path file = run.particles(number);
    frame.particles = read_particles(file);
    if (!(frame.particles.shift == run.record.shift))
      fail_input("{}: its places count from ({}, {}, {}), those of the run from ({}, {}, {})", file.string(),
                 frame.particles.shift.x, frame.particles.shift.y, frame.particles.shift.z, run.record.shift.x,
                 run.record.shift.y, run.record.shift.z);
    count_by_scene(frame.particles, clip, file.string());
    frame.colors = colors_of(run, clip, frame.particles);
    clip.axes.apply(frame.particles);
  }
  if (clip.foam) frame.foam = foam_frame(run, clip, number), clip.axes.apply(frame.foam);
  for (const int m : clip.meshed) {
    frame.meshes.push_back(read_mesh(surface_file(run, m, number), &frame.attributes.emplace_back()));
    clip.axes.apply(frame.meshes.back()), clip.axes.apply(frame.attributes.back());
  }
  if (objects) frame.objects = objects->in(run.frame_record(number));
  return frame;
}

const Format& format_named(const std::string& name) {
  const auto& all = formats();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Format& f) { return name == f.name; });
  if (found != all.end()) return *found;
  std::string names;
  for (const Format& f : all) names += (names.empty() ? "" : ", ") + std::string(f.name);
  fail_input("no format '{}': {} are written", name, names);
}

/// The file, or the folder, with what is in its way refused before any work.
fs::path target_of(const RunFolder& run, const ClipInfo& clip, const Format& format, const ExportOptions& options) {
  const fs::path own = run.folder / "export";
  if (!format.one_file()) {
    const fs::path folder = options.out.empty() ? own / format.name : options.out;
    make_folder(folder);
    return folder;
  }
  const fs::path file = options.out.empty() ? own / (clip.name + format.extension) : options.out;
  if (file.extension() != format.extension)
    fail_input("{}: a file of --to {} ends with {}{}", file.string(), format.name, format.extension,
               file.extension() == ".usdc" || file.extension() == ".usd"
                   ? "; usdcat of the package usd-core turns it into .usdc"
                   : "");
  if (options.out.empty()) make_folder(own);
  for (const fs::path& f : format.files(clip, file)) check_replaceable(f);
  return file;
}

ClipInfo clip_of(const RunFolder& run, const ExportOptions& options, const std::vector<int>& frames) {
  const model::Scene& scene = run.scene;
  ClipInfo clip;
  clip.name = scene.name;
  clip.axes = options.axes;
  clip.fps = scene.time.fps;
  clip.first = frames.front(), clip.last = frames.back();
  clip.spacing = scene.space.spacing * options.axes.scale;
  clip.shift = options.axes.placed(run.record.shift);
  for (int m = 0; m < static_cast<int>(scene.materials.size()); ++m)
    clip.materials.push_back(material_of(scene.materials[std::size_t(m)].name, material_look(scene, m)));
  clip.particles = options.particles;
  clip.meshed = meshed_of(run, options, frames);
  clip.foam = foam_of(run, options, frames);
  if (clip.foam) clip.foam_look.color = linear_color(scene.foam->color);
  clip.camera = camera_of(scene, options.axes);
  return clip;
}

}  // namespace

ExportResult export_run(const RunFolder& run, const ExportOptions& options) {
  const Format& format = format_named(options.format);
  const double scale = options.axes.scale;
  if (!(scale > 0) || !std::isfinite(scale)) fail_input("scale is {}: must be above 0", scale);
  if (format.y_up && options.axes.up == Up::z)
    fail_input("--up z: in {} Y is up by definition, and programs turn it where they read it; leave --up out",
               format.name);
  const std::vector<int> frames = run.chosen(options.first, options.last);
  if (frames.empty()) fail_input("{}: no frame is simulated; dreampm run makes them", run.folder.string());
  ClipInfo clip = clip_of(run, options, frames);
  std::optional<Objects> objects;
  if (options.colliders)
    objects.emplace(run, options.axes, run.frame_record(frames.front())), clip.objects = objects->list();
  if (!clip.particles && !clip.foam && clip.meshed.empty() && clip.objects.empty())
    fail_input("{}: has no colliders or rigid bodies; --what all exports what there is", run.folder.string());
  const fs::path target = target_of(run, clip, format, options);
  const std::unique_ptr<ClipWriter> writer = format.writer(clip, target);
  Progress progress("export: frame", frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (interrupted()) throw Interrupted(fmt::format("export: interrupted before frame {}", frames[i]));
    progress.update(i);
    writer->add(load(run, clip, objects, frames[i]));
  }
  writer->finish();
  progress.update(frames.size());
  ExportResult result{{target}, frames.size(), clip.meshed.size(), clip.objects.size(), clip.particles};
  if (format.one_file()) result.files = format.files(clip, target);
  return result;
}

}  // namespace dreampm
