#include "dreampm/scene/emit.h"

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/base/hash.h"
#include "dreampm/scene/attributes.h"
#include "dreampm/scene/files.h"
#include "dreampm/scene/parse.h"
#include "dreampm/scene/sections.h"

namespace dreampm::scene {
namespace {

/// The bytes of every file that shapes name, in place of the path. A file that is gone counts by
/// its name.
void add_file(Hash64& hash, const std::string& path) {
  if (path.starts_with("asset:")) return hash.add(std::string_view(path));
  try {
    for (const std::filesystem::path& file : model_files(path)) hash.add(std::string_view(read_file(file)));
  } catch (const InputError&) {
    hash.add(std::string_view(fmt::format("absent: {}", path)));
  }
}

void add_files(Hash64& hash, Shape shape) {
  each_model(shape, [&](std::string& path) { add_file(hash, path); });
}

void forget_paths(Shape& shape) {
  each_model(shape, [](std::string& path) { path.clear(); });
}

void add_simulation(Hash64& hash, model::Scene s) {
  for (const Body& b : s.bodies) add_files(hash, b.shape);
  for (const Collider& c : s.colliders) add_files(hash, c.shape);
  for (const Emitter& e : s.emitters) add_files(hash, e.shape);
  for (const Sink& k : s.sinks) add_files(hash, k.shape);
  if (!s.start.empty()) add_file(hash, s.start);
  s.space.max = s.space.end();  // what was rounded up to the same walls is the same
  s.time.frames = 1;
  for (Body& b : s.bodies) forget_paths(b.shape), b.color.reset();
  for (Collider& c : s.colliders) forget_paths(c.shape);
  for (Emitter& e : s.emitters) forget_paths(e.shape), e.color.reset();
  for (Sink& k : s.sinks) forget_paths(k.shape);
  YamlNode decides = YamlNode::map();
  decides.put("seed", write_count(static_cast<std::int64_t>(s.seed)));
  gravity().write(s, "gravity", decides);
  decides.put("space", write_map(s.space, space_schema()));
  decides.put("time", write_map(s.time, time_schema()));
  decides.put("materials", write_materials(s));
  decides.put("bodies", write_bodies(s));
  decides.put("colliders", write_colliders(s));
  if (YamlNode rigid = write_rigid(s); !rigid.entries.empty()) decides.put("rigid", std::move(rigid));
  if (!s.emitters.empty()) decides.put("emitters", write_emitters(s));
  if (!s.sinks.empty()) decides.put("sinks", write_sinks(s));
  if (!s.fields.empty()) decides.put("fields", write_fields(s));
  hash.add(std::string_view(write_yaml(decides)));
}

void add_colors(Hash64& hash, const model::Scene& s) {
  for (const Body& b : s.bodies)
    hash.add(std::string_view(b.color ? fmt::format("{} {} {}", b.color->x, b.color->y, b.color->z) : "none"));
  for (const Emitter& e : s.emitters)
    if (e.color) hash.add(std::string_view(fmt::format("{} {}", e.name, yaml_list(*e.color))));
}

void add_text(Hash64& hash, const YamlNode& map) { hash.add(std::string_view(write_yaml(map))); }

/// Files beside the mesh do not change it. What earlier versions did not have is left out where it
/// is as they did it.
void add_surface(Hash64& hash, const model::Scene& s) {
  Surface of_mesh = s.surface;
  of_mesh.format = SurfaceFormat::ply;
  YamlNode map = write_map(of_mesh, surface_schema());
  std::erase_if(map.entries, [&](const Entry& e) {
    return e.key == "type" || (e.key == "attributes" && of_mesh.attributes == Surface{}.attributes);
  });
  add_text(hash, map);
  const auto& names = of_mesh.attributes;
  if (std::find(names.begin(), names.end(), "color") != names.end()) add_colors(hash, s);
}

/// Probes change no state, but only a new simulation measures with new ones.
void add_probes(Hash64& hash, model::Scene s) {
  for (Probe& p : s.probes)
    if (RegionProbe* region = std::get_if<RegionProbe>(&p.form)) {
      add_files(hash, region->shape);
      forget_paths(region->shape);
    }
  if (!s.probes.empty()) add_text(hash, write_probes(s));
}

}  // namespace

std::string yaml_list(const Vec3d& v) { return fmt::format("[{}, {}, {}]", v.x, v.y, v.z); }

std::string write_scene(const model::Scene& scene) {
  YamlNode root = YamlNode::map();
  root.put("dreampm", write_count(format_version));
  for (Entry& e : write_map(scene, scene_schema()).entries) root.entries.push_back(std::move(e));
  return write_yaml(root);
}

std::string scene_hash(const model::Scene& scene, Part part, const std::string& simulation) {
  Hash64 hash;
  if (part <= Part::particles || simulation.empty()) add_simulation(hash, scene);
  if (part == Part::simulation) return hash.hex();
  if (part == Part::particles) {
    Output o = scene.output;
    o.folder.clear();
    o.checkpoint_every = 0;
    o.attributes = kept_attributes(scene);
    add_text(hash, write_map(o, output_schema()));
    add_probes(hash, scene);
    if (std::find(o.attributes.begin(), o.attributes.end(), "color") != o.attributes.end()) add_colors(hash, scene);
    return hash.hex();
  }
  Hash64 later;
  later.add(std::string_view(simulation.empty() ? hash.hex() : simulation));
  if (part == Part::foam) {
    if (!scene.foam) return later.hex();
    model::Foam f = *scene.foam;
    f.color = {};  // it is for pictures
    add_text(later, write_map(f, foam_schema()));
    return later.hex();
  }
  add_surface(later, scene);
  if (part >= Part::render) {
    model::Render r = scene.render;
    r.format = model::PictureFormat::png;  // it adds files; the picture is the same
    if (std::string& environment = r.light.environment; !environment.empty()) {
      add_file(later, environment);
      environment = "its bytes";
    }
    add_text(later, write_map(r, render_schema()));
    if (scene.foam) later.add(std::string_view(yaml_list(scene.foam->color)));
    add_colors(later, scene);
  }
  if (part == Part::video) add_text(later, write_map(scene.video, video_schema()));
  return later.hex();
}

std::string probe_hash(const model::Scene& scene, const model::Probe& probe) {
  model::Scene alone = scene;
  alone.probes = {probe};
  Hash64 hash;
  add_probes(hash, std::move(alone));
  return hash.hex();
}

}  // namespace dreampm::scene
