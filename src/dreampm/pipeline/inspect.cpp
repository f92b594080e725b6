#include "dreampm/pipeline/inspect.h"

#include <fmt/format.h>

#include "dreampm/base/error.h"
#include "dreampm/geometry/asset.h"
#include "dreampm/geometry/import.h"
#include "dreampm/io/ply.h"
#include "dreampm/pipeline/checkpoint.h"
#include "dreampm/pipeline/run_folder.h"
#include "dreampm/scene/emit.h"
#include "dreampm/scene/parse.h"

namespace dreampm {
namespace fs = std::filesystem;
namespace {

Inspection inspect_mesh(const std::string& name) {
  const TriMesh mesh = load_mesh(name);
  Inspection out;
  out.kind = "mesh";
  out.count = mesh.vertices.size();
  Box3d bounds;
  for (const Vec3f& v : mesh.vertices) bounds.add(static_cast<Vec3d>(v));
  if (!mesh.vertices.empty()) out.bounds = bounds;
  double six = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3d a = static_cast<Vec3d>(mesh.vertices[t[0]]), b = static_cast<Vec3d>(mesh.vertices[t[1]]),
                c = static_cast<Vec3d>(mesh.vertices[t[2]]);
    six += dot(a, cross(b, c));
  }
  out.volume = six / 6;
  out.facts["triangles"] = fmt::format("{}", mesh.triangles.size());
  return out;
}

/// The run that a particle file lies in, and the file's frame, if both are there.
std::optional<std::pair<RunFolder, int>> run_of(const fs::path& file) {
  const fs::path folder = fs::absolute(file).parent_path().parent_path();
  if (!fs::exists(folder / "run.json") || !fs::exists(folder / "scene.yaml")) return std::nullopt;
  RunFolder run = open_run(folder);
  for (const FrameRecord& f : run.record.frames)
    if (run.particles(f.frame).filename() == file.filename()) return std::pair(std::move(run), f.frame);
  return std::nullopt;
}

Inspection inspect_particles(const fs::path& file, const PlyElement& vertex) {
  const ParticleFrame frame = read_particles(file);
  Inspection out;
  out.kind = "particles";
  out.count = frame.size();
  for (const PlyProperty& p : vertex.properties) out.attributes.push_back(p.name);
  Box3d bounds;
  for (const Vec3f& x : frame.position) bounds.add(static_cast<Vec3d>(x));
  if (frame.size() > 0) out.bounds = bounds;
  for (const std::uint8_t m : frame.material)
    if (m < frame.material_names.size()) ++out.by_material[frame.material_names[m]];
  const auto found = run_of(file);
  if (!found) return out;
  const auto& [run, number] = *found;
  std::map<std::string, double> masses;  // of one particle
  for (const scene::Material& m : run.scene.materials)
    masses[m.name] = m.values["density"] * std::pow(run.scene.space.spacing, 3);
  double mass = 0;
  Vec3d momentum{};
  for (std::size_t i = 0; i < frame.size(); ++i) {
    const double m = masses.at(frame.material_names.at(frame.material[i]));
    mass += m;
    if (!frame.velocity.empty()) momentum += static_cast<Vec3d>(frame.velocity[i]) * m;
  }
  out.mass = mass;
  if (vertex.find("vx")) out.momentum = momentum;
  out.state_hash = run.state_hash(number);
  out.facts["frame"] = fmt::format("{}", number);
  return out;
}

Inspection inspect_ply(const fs::path& file) {
  const PlyHeader header = read_ply_header(file);
  const PlyElement* face = header.find("face");
  if (face && face->count > 0) return inspect_mesh(file.string());
  const PlyElement* vertex = header.find("vertex");
  if (!vertex) fail_input("{}: has no element vertex: neither a mesh nor particles", file.string());
  return inspect_particles(file, *vertex);
}

Inspection inspect_scene(const fs::path& file) {
  const SceneDescription scene = scene::load_scene(file, {.variant = {}, .overrides = {}, .assets = asset_names()});
  Inspection out;
  out.kind = "scene";
  out.count = scene.bodies.size();
  out.bounds = Box3d{scene.space.min, scene.space.max};
  for (const scene::Material& m : scene.materials) out.attributes.push_back(m.name);
  out.facts["name"] = scene.name;
  if (!scene.about.empty()) out.facts["about"] = scene.about;
  out.facts["frames"] = fmt::format("{}", scene.time.frames);
  out.facts["spacing"] = fmt::format("{}", scene.space.spacing);
  out.facts["dx"] = fmt::format("{}", scene.space.dx());
  out.facts["scene_hash"] = scene::scene_hash(scene, scene::Part::simulation);
  return out;
}

Inspection inspect_run(const fs::path& folder) {
  const RunFolder run = open_run(folder);
  Inspection out;
  out.kind = "run";
  out.count = run.record.frames.size();
  out.bounds = Box3d{run.scene.space.min, run.scene.space.max};
  for (const scene::Material& m : run.scene.materials) out.attributes.push_back(m.name);
  if (!run.record.frames.empty()) out.state_hash = run.record.frames.back().state_hash;
  out.facts["name"] = run.scene.name;
  out.facts["status"] = run.record.status;
  if (run.record.cause) out.facts["cause"] = *run.record.cause;
  out.facts["particles"] = fmt::format("{}", run.record.particles);
  out.facts["frames asked for"] = fmt::format("{}", run.scene.time.frames);
  out.facts["backend"] = run.record.backend + ", " + run.record.machine.isa;
  std::string probes;
  for (const auto& [name, type] : run.record.probes) probes += (probes.empty() ? "" : ", ") + name + " (" + type + ")";
  if (!probes.empty()) out.facts["probes"] = probes;
  for (const auto& [name, stage] : run.record.stages)
    if (stage.seconds) out.facts[name] = fmt::format("{} frames, {:.1f} s", stage.frames.value_or(0), *stage.seconds);
  return out;
}

Inspection inspect_checkpoint(const fs::path& file) {
  const CheckpointInfo info = checkpoint_info(file);
  Inspection out;
  out.kind = "checkpoint";
  out.count = 1;
  out.facts["scene_hash"] = info.scene_hash;
  out.facts["backend"] = info.backend;
  out.facts["isa"] = info.isa;
  out.facts["particle_steps"] = fmt::format("{}", info.particle_steps);
  return out;
}

}  // namespace

Inspection inspect(const fs::path& path) {
  if (is_asset(path.string())) return inspect_mesh(path.string());
  if (fs::is_directory(path)) return inspect_run(path);
  if (!fs::exists(path)) fail_input("{}: no such file or folder", path.string());
  const std::string extension = path.extension().string();
  if (extension == ".yaml" || extension == ".yml") return inspect_scene(path);
  if (extension == ".h5") return inspect_checkpoint(path);
  if (extension == ".ply") return inspect_ply(path);
  return inspect_mesh(path.string());
}

}  // namespace dreampm
