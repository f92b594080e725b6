#include <algorithm>
#include <map>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/base/interrupt.h"
#include "dreampm/base/log.h"
#include "dreampm/base/progress.h"
#include "dreampm/geometry/openness.h"
#include "dreampm/import/import.h"
#include "dreampm/import/point_cloud.h"
#include "dreampm/io/ply.h"
#include "dreampm/math/srgb.h"
#include "dreampm/pipeline/loose_files.h"
#include "dreampm/pipeline/loose_names.h"
#include "dreampm/pipeline/render_stage.h"
#include "dreampm/render/denoise.h"
#include "dreampm/render/from_scene.h"

namespace dreampm {
namespace fs = std::filesystem;
namespace {

const std::map<std::string, model::Look>& looks() {
  static const std::map<std::string, model::Look> all{
      {"water", model::Look::dielectric()},
      {"glass", model::Look::dielectric(1.5, {0.4, 0.2, 0.3})},
      {"clay", model::Look::opaque({0.93, 0.33, 0.23})},
      {"plastic", model::Look::plastic()},
      {"metal", model::Look::metal()},
  };
  return all;
}

/// One file, with Y up, its places where a PLY file of this program says that they belong: those of
/// the next one may count from elsewhere.
Model load(const std::string& file, exchange::Up up) {
  Model model = read_model(file);
  const Vec3d shift = read_ply_shift(file);
  for (Vec3d& p : model.vertices) p = exchange::Axes{up}.turned_back(p + shift);
  return model;
}

/// What all pictures have in common.
struct View {
  RenderScene scene;
  Vec3d shift{};         ///< where places of pictures count from
  double longest = 1;    ///< of all that is shown
  double radius = 0.01;  ///< of balls
};

/// Reads all files once: the camera has to see what comes.
View view_of(const LoosePictures& request) {
  Box3d box;
  std::optional<double> spacing = request.spacing;
  bool balls = false;
  for (const std::string& file : request.files) {
    if (interrupted()) throw Interrupted("render: interrupted before the first picture");
    const Model model = load(file, request.up);
    for (const std::string& w : model.warnings) warn("{}", w);
    const Box3d own = bounds_of(model);
    box.add(own.min), box.add(own.max);
    balls = balls || model.triangles.empty();
    if (model.triangles.empty() && !spacing) spacing = look_at_cloud(model.vertices).spacing;
  }
  View view;
  const Vec3d size = box.size();
  view.longest = std::max({size.x, size.y, size.z});
  if (!(view.longest > 0)) fail_input("{}: all that is to be drawn lies in one place", request.files[0]);
  view.radius = 0.5 * spacing.value_or(view.longest / 50);
  const Vec3d margin = Vec3d{1, 1, 1} * std::max(balls ? view.radius : 0, 1e-3 * view.longest);
  view.shift = box.min;
  RenderScene& scene = view.scene;
  scene.basin = {static_cast<Vec3f>(-margin), static_cast<Vec3f>(size + margin)};
  scene.is_wall.fill(false);
  scene.stage.basin = model::Basin::none;
  scene.camera.azimuth = request.azimuth;
  scene.camera.elevation = request.elevation;
  return view;
}

/// Nothing says how long a unit is: what is clear looks as if the longest side were a meter.
model::Look look_of(const LoosePictures& request, const Model& model, const View& view) {
  const bool closed = !model.triangles.empty() && openness(model).open_edges == 0;
  model::Look look = looks().at(!request.look.empty() ? request.look : closed ? "water" : "clay");
  if (look.type != model::LookType::dielectric) return look;
  if (!closed) fail_input("--look {}: clear matter needs a closed mesh; clay, plastic and metal do not", request.look);
  look.absorption = look.absorption / view.longest;
  return look;
}

Picture draw(const Model& model, const model::Look& look, const View& view, const RenderSettings& settings) {
  RenderScene scene = view.scene;
  const TriMesh mesh = about(model, view.shift);
  std::vector<Vec3f> colors;
  for (const auto& c : model.colors) colors.push_back(linear_color(Vec3d{c[0] / 255.0, c[1] / 255.0, c[2] / 255.0}));
  if (model.triangles.empty())
    scene.objects.push_back({RenderSpheres{mesh.vertices, static_cast<float>(view.radius), colors}, look, {}});
  else if (look.type == model::LookType::opaque)
    scene.objects.push_back({&mesh, look, colors});
  else
    scene.objects.push_back({&mesh, look, {}});
  return render_picture(scene, settings);
}

}  // namespace

std::vector<std::string> picture_looks() {
  std::vector<std::string> names;
  for (const auto& [name, look] : looks()) names.push_back(name);
  return names;
}

std::vector<fs::path> render_files(const LoosePictures& request) {
  if (!request.look.empty() && !looks().contains(request.look)) fail_input("no look '{}'", request.look);
  const std::vector<fs::path> names = loose_names(request.files, request.out, ".png");
  RenderSettings settings;
  settings.width = 1280, settings.height = 720;
  settings = wished(settings, request.wishes);
  settings.crop = request.crop;
  if (settings.denoise) check_denoiser();
  const View view = view_of(request);
  check_render(view.scene, settings);
  Progress progress("render: file", names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (interrupted()) throw Interrupted(fmt::format("render: interrupted before {}", request.files[i]));
    progress.update(i);
    const Model model = load(request.files[i], request.up);
    const model::Look look = look_of(request, model, view);
    make_folder(request.out);
    write_picture(names[i], draw(model, look, view, settings));
  }
  progress.update(names.size());
  return names;
}

}  // namespace dreampm
