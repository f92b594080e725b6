#include "dreampm/scene/emit.h"

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/base/hash.h"
#include "dreampm/scene/parse.h"
#include "dreampm/scene/sections.h"

namespace dreampm::scene {
namespace {

/// The bytes of every file that shapes name, in place of the path. A file that is gone counts by its name.
void add_files(Hash64& hash, const Shape& shape) {
  std::string path;
  if (const MeshShape* m = std::get_if<MeshShape>(&shape.form)) path = m->path;
  if (const PointsShape* p = std::get_if<PointsShape>(&shape.form)) path = p->path;
  if (!path.empty()) {
    std::string bytes = path;
    if (!path.starts_with("asset:")) {
      try {
        bytes = read_file(path);
      } catch (const InputError&) {
        bytes = fmt::format("absent: {}", path);
      }
    }
    hash.add(std::string_view(bytes));
  }
  if (const BooleanShape* b = std::get_if<BooleanShape>(&shape.form))
    for (const Shape& part : b->parts) add_files(hash, part);
}

void forget_paths(Shape& shape) {
  if (MeshShape* m = std::get_if<MeshShape>(&shape.form)) m->path.clear();
  if (PointsShape* p = std::get_if<PointsShape>(&shape.form)) p->path.clear();
  if (BooleanShape* b = std::get_if<BooleanShape>(&shape.form))
    for (Shape& part : b->parts) forget_paths(part);
}

void add_simulation(Hash64& hash, SceneDescription s) {
  for (const Body& b : s.bodies) add_files(hash, b.shape);
  for (const Collider& c : s.colliders) add_files(hash, c.shape);
  s.space.asked_max = s.space.max;  // what was rounded up to the same walls is the same
  s.time.frames = 1;
  for (Body& b : s.bodies) forget_paths(b.shape), b.color.reset();
  for (Collider& c : s.colliders) forget_paths(c.shape);
  Node decides = Node::map();
  decides.put("seed", write_count(static_cast<std::int64_t>(s.seed)));
  gravity().write(s, "gravity", decides);
  decides.put("space", write_map(s.space, space_schema()));
  decides.put("time", write_map(s.time, time_schema()));
  decides.put("materials", write_materials(s));
  decides.put("bodies", write_bodies(s));
  decides.put("colliders", write_colliders(s));
  if (!s.fields.empty()) decides.put("fields", write_fields(s));
  hash.add(std::string_view(write_yaml(decides)));
}

void add_colors(Hash64& hash, const SceneDescription& s) {
  for (const Body& b : s.bodies)
    hash.add(std::string_view(b.color ? fmt::format("{} {} {}", b.color->x, b.color->y, b.color->z) : "none"));
}

void add_text(Hash64& hash, const Node& map) { hash.add(std::string_view(write_yaml(map))); }

/// What is measured changes no state, but only a new simulation measures it.
void add_probes(Hash64& hash, SceneDescription s) {
  for (Probe& p : s.probes)
    if (RegionProbe* region = std::get_if<RegionProbe>(&p.form)) {
      add_files(hash, region->shape);
      forget_paths(region->shape);
    }
  if (!s.probes.empty()) add_text(hash, write_probes(s));
}

}  // namespace

std::string emit_scene(const SceneDescription& scene) {
  Node root = Node::map();
  root.put("dreampm", write_count(format_version));
  for (Entry& e : write_map(scene, scene_schema()).entries) root.entries.push_back(std::move(e));
  return write_yaml(root);
}

std::string scene_hash(const SceneDescription& scene, Part part) {
  Hash64 hash;
  add_simulation(hash, scene);
  if (part == Part::particles) {
    Output o = scene.output;
    o.folder.clear();
    o.checkpoint_every = 0;
    add_text(hash, write_map(o, output_schema()));
    add_probes(hash, scene);
    if (std::find(o.attributes.begin(), o.attributes.end(), "color") != o.attributes.end()) add_colors(hash, scene);
  }
  if (part >= Part::surface) {
    Surface s = scene.surface;
    s.format = SurfaceFormat::ply;  // it adds files; the mesh is the same
    add_text(hash, write_map(s, surface_schema()));
  }
  if (part >= Part::render) {
    add_text(hash, write_map(scene.render, render_schema()));
    add_colors(hash, scene);
  }
  if (part == Part::video) add_text(hash, write_map(scene.video, video_schema()));
  return hash.hex();
}

std::string probe_hash(const SceneDescription& scene, const Probe& probe) {
  SceneDescription alone = scene;
  alone.probes = {probe};
  Hash64 hash;
  add_probes(hash, std::move(alone));
  return hash.hex();
}

}  // namespace dreampm::scene
