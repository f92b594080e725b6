#include "dreampm/pipeline/inspect.h"

#include <fmt/format.h>

#include "dreampm/base/error.h"
#include "dreampm/base/log.h"
#include "dreampm/geometry/openness.h"
#include "dreampm/import/asset.h"
#include "dreampm/import/import.h"
#include "dreampm/import/point_cloud.h"
#include "dreampm/io/archive.h"
#include "dreampm/io/ply.h"
#include "dreampm/pipeline/checkpoint.h"
#include "dreampm/pipeline/foam_stage.h"
#include "dreampm/pipeline/run_folder.h"
#include "dreampm/pipeline/surface_stage.h"
#include "dreampm/scene/emit.h"
#include "dreampm/scene/parse.h"
#include "dreampm/setup/assemble.h"
#include "dreampm/setup/start.h"

namespace dreampm {
namespace fs = std::filesystem;
namespace {

/// The run that a file in one of its folders belongs to, and its frame, if `file_of` names it so.
template <class FileOf>
std::optional<std::pair<RunFolder, int>> run_of(const fs::path& file, const FileOf& file_of) {
  const fs::path folder = fs::absolute(file).parent_path().parent_path();
  if (!fs::exists(folder / "run.json") || !fs::exists(folder / "scene.yaml")) return std::nullopt;
  RunFolder run = open_run(folder);
  for (const FrameRecord& f : run.record.frames)
    if (file_of(run, f.frame)) return std::pair(std::move(run), f.frame);
  return std::nullopt;
}

std::uint64_t count_of(const ParticleFrame& frame, const std::string& material) {
  std::uint64_t n = 0;
  for (const std::uint8_t m : frame.material) n += frame.material_names.at(m) == material;
  return n;
}

/// For a mesh that the surface stage made: which matter it wraps, and how much of that there is.
void add_wrapped(const fs::path& file, Inspection& out) {
  int material = -1;
  const auto found = run_of(file, [&](const RunFolder& run, int frame) {
    for (const int m : meshed_materials(run.scene))
      if (surface_file(run, m, frame, file.extension().string()).filename() == file.filename()) material = m;
    return material >= 0;
  });
  if (!found) return;
  const auto& [run, number] = *found;
  const std::string& name = run.scene.materials[std::size_t(material)].name;
  const double volume =
      static_cast<double>(count_of(read_particles(run.particles(number)), name)) * std::pow(run.scene.space.spacing, 3);
  out.facts["frame"] = static_cast<std::uint64_t>(number);
  out.facts["material"] = name;
  out.facts["particles_volume"] = volume;
  // Without what reaches into walls and colliders, where the run knows that.
  double enclosed = *out.volume;
  if (const auto stage = run.record.stages.find("surface"); stage != run.record.stages.end())
    for (const VolumeRecord& v : stage->second.volumes) {
      if (v.frame != number || v.material != name) continue;
      enclosed = v.mesh;
      if (v.taken) out.facts["taken_volume"] = *v.taken;
    }
  if (volume > 0) out.facts["volume_error"] = enclosed / volume - 1;
}

/// Says where the file's places count from, and puts the bounds there.
void add_shift(const Vec3d& shift, Inspection& out) {
  if (shift == Vec3d{}) return;
  if (out.bounds) out.bounds = Box3d{out.bounds->min + shift, out.bounds->max + shift};
  out.facts["shift"] = fmt::format("{} {} {}", shift.x, shift.y, shift.z);
}

Inspection inspect_mesh(const std::string& name, const Model& mesh) {
  for (const std::string& w : mesh.warnings) warn("{}", w);
  Inspection out;
  out.kind = "mesh";
  out.count = mesh.vertices.size();
  Box3d bounds;
  for (const Vec3d& v : mesh.vertices) bounds.add(v);
  out.bounds = bounds;
  out.volume = enclosed_volume(mesh);
  out.facts["triangles"] = std::uint64_t(mesh.triangles.size());
  const Openness open = openness(mesh);
  out.facts["open_edges"] = std::uint64_t(open.open_edges);
  if (open.open_edges > 0) out.facts["holes"] = std::uint64_t(open.holes), out.facts["widest_hole"] = open.widest;
  if (!is_asset(name)) add_wrapped(name, out);
  return out;
}

Inspection inspect_particles(const fs::path& file) {
  const ParticleFrame frame = read_particles(file);
  Inspection out;
  out.kind = "particles";
  out.count = frame.size();
  const PlyHeader header = read_ply_header(file);
  for (const PlyProperty& p : header.find("vertex")->properties) out.attributes.push_back(p.name);
  Box3d bounds;
  for (const Vec3f& x : frame.position) bounds.add(static_cast<Vec3d>(x));
  if (frame.size() > 0) out.bounds = bounds;
  add_shift(frame.shift, out);
  for (const std::uint8_t m : frame.material)
    if (m < frame.material_names.size()) ++out.by_material[frame.material_names[m]];
  const auto found =
      run_of(file, [&](const RunFolder& run, int n) { return run.particles(n).filename() == file.filename(); });
  if (!found) return out;
  const auto& [run, number] = *found;
  std::map<std::string, double> masses;  // of one particle
  for (const model::Material& m : run.scene.materials)
    masses[m.name] = m.values["density"] * std::pow(run.scene.space.spacing, 3);
  double mass = 0;
  Vec3d momentum{};
  for (std::size_t i = 0; i < frame.size(); ++i) {
    const double m = masses.at(frame.material_names.at(frame.material[i]));
    mass += m;
    if (!frame.velocity.empty()) momentum += static_cast<Vec3d>(frame.velocity[i]) * m;
  }
  out.mass = mass;
  if (header.find("vertex")->find("vx")) out.momentum = momentum;
  out.state_hash = run.state_hash(number);
  out.facts["frame"] = static_cast<std::uint64_t>(number);
  return out;
}

Inspection inspect_cloud(const MovingCloud& cloud) {
  Inspection out;
  out.kind = "points";
  if (!cloud.velocities.empty()) out.attributes.push_back("velocity");
  if (!cloud.ids.empty()) out.attributes.push_back("id");
  if (!cloud.colors.empty()) out.attributes.push_back("color");
  Box3d bounds;
  for (const Vec3d& x : cloud.points) bounds.add(x);
  out.count = cloud.points.size();
  out.bounds = bounds;
  return out;
}

Inspection inspect_ply(const fs::path& file) {
  const PlyHeader header = read_ply_header(file);
  if (header.has_faces()) {
    Inspection out = inspect_mesh(file.string(), load_mesh(file.string()));
    add_shift(ply_shift(header, file.string()), out);
    if (const PlyElement* v = header.find("vertex"))
      for (const PlyProperty& p : v->properties) out.attributes.push_back(p.name);
    return out;
  }
  const PlyElement* vertex = header.find("vertex");
  if (!vertex) fail_input("{}: has no element vertex: neither a mesh nor particles", file.string());
  if (vertex->find("id") && vertex->find("material")) return inspect_particles(file);
  Inspection out = inspect_cloud(read_moving_cloud(file));
  out.attributes.clear();
  for (const PlyProperty& p : vertex->properties) out.attributes.push_back(p.name);
  return out;
}

Inspection inspect_scene(const fs::path& file) {
  const model::Scene scene = scene::load_scene(file, {.variant = {}, .overrides = {}, .assets = asset_names()});
  const InitialState start = assemble(scene, file.string());
  Inspection out;
  out.kind = "scene";
  out.count = scene.bodies.size();
  out.bounds = Box3d{scene.space.min, scene.space.end()};
  for (const model::Material& m : scene.materials) out.attributes.push_back(m.name);
  double mass = 0;
  Vec3d momentum{};
  for (std::size_t s = 0; s < start.seeds.size(); ++s) {
    const auto& set = start.world.sets[s];
    out.by_material[set.name] = start.seeds[s].size();
    for (const ParticleSeed& p : start.seeds[s]) mass += set.mass, momentum += p.velocity * set.mass;
  }
  if (!scene.start.empty()) {
    for (std::size_t s = 0; s < start.started.size(); ++s) {
      const auto& set = start.world.sets[s];
      out.by_material[set.name] = start.started[s];
      mass += set.mass * static_cast<double>(start.started[s]);
    }
    momentum = start_info(scene.start).momentum;
  }
  out.mass = mass;
  out.momentum = momentum;
  out.facts["name"] = scene.name;
  if (!scene.about.empty()) out.facts["about"] = scene.about;
  out.facts["particles"] = std::uint64_t(start.particles());
  out.facts["frames"] = static_cast<std::uint64_t>(scene.time.frames);
  out.facts["spacing"] = scene.space.spacing;
  out.facts["dx"] = scene.space.dx();
  out.facts["scene_hash"] = scene::scene_hash(scene, scene::Part::simulation);
  return out;
}

Inspection inspect_run(const fs::path& folder) {
  const RunFolder run = open_run(folder);
  Inspection out;
  out.kind = "run";
  out.count = run.record.frames.size();
  out.bounds = Box3d{run.scene.space.min, run.scene.space.end()};
  for (const model::Material& m : run.scene.materials) out.attributes.push_back(m.name);
  if (!run.record.frames.empty()) {
    const FrameRecord& last = run.record.frames.back();
    out.state_hash = last.state_hash;
    if (const fs::path file = run.particles(last.frame); fs::exists(file)) {
      const Inspection particles = inspect_particles(file);
      out.mass = particles.mass, out.momentum = particles.momentum, out.by_material = particles.by_material;
    }
  }
  out.facts["name"] = run.scene.name;
  out.facts["status"] = run.record.status;
  if (run.record.cause) out.facts["cause"] = *run.record.cause;
  if (run.record.failed_stage) out.facts["failed_stage"] = *run.record.failed_stage;
  out.facts["particles"] = run.record.particles;
  out.facts["frames_asked"] = static_cast<std::uint64_t>(run.scene.time.frames);
  out.facts["backend"] = run.record.backend;
  out.facts["isa"] = run.record.machine.isa;
  std::string earlier;
  for (const EarlierBackend& b : run.record.earlier_backends)
    earlier += fmt::format("{}{} ({}) to frame {}", earlier.empty() ? "" : ", ", b.backend, b.isa, b.last_frame);
  if (!earlier.empty()) out.facts["earlier_backends"] = earlier;
  std::string probes;
  for (const auto& [name, type] : run.record.probes) probes += (probes.empty() ? "" : ", ") + name + " (" + type + ")";
  if (!probes.empty()) out.facts["probes"] = probes;
  for (const auto& [name, stage] : run.record.stages)
    if (stage.seconds) {
      out.facts[name + "_frames"] = stage.frames.value_or(0);
      out.facts[name + "_seconds"] = *stage.seconds;
    }
  std::string volumes;
  for (const std::string& line : volume_lines(run.record)) volumes += (volumes.empty() ? "" : "; ") + line;
  if (!volumes.empty()) out.facts["volumes"] = volumes;
  std::string foam;
  for (const std::string& line : foam_lines(run.record)) foam += (foam.empty() ? "" : "; ") + line;
  if (!foam.empty()) out.facts["foam"] = foam;
  return out;
}

Inspection inspect_checkpoint(const fs::path& file) {
  const CheckpointInfo info = checkpoint_info(file);
  Inspection out;
  out.kind = "checkpoint";
  out.count = info.particles;
  out.facts["frame"] = static_cast<std::uint64_t>(info.frame);
  out.facts["time"] = info.time;
  out.facts["scene_hash"] = info.scene_hash;
  out.facts["backend"] = info.backend;
  out.facts["isa"] = info.isa;
  out.facts["particle_steps"] = info.particle_steps;
  return out;
}

/// A moment that a scene may start from.
Inspection inspect_start(const fs::path& file) {
  const StartInfo info = start_info(file);
  Inspection out;
  out.kind = "start";
  for (const auto& [material, count] : info.particles) out.by_material[material] = count, out.count += count;
  out.momentum = info.momentum;
  out.facts["frame"] = static_cast<std::uint64_t>(info.frame);
  out.facts["time"] = info.time;
  return out;
}

}  // namespace

Inspection inspect(const fs::path& path) {
  if (is_asset(path.string())) return inspect_mesh(path.string(), load_mesh(path.string()));
  if (fs::is_directory(path)) return inspect_run(path);
  if (!fs::exists(path)) fail_input("{}: no such file or folder", path.string());
  const std::string extension = path.extension().string();
  if (extension == ".yaml" || extension == ".yml") return inspect_scene(path);
  if (extension == ".h5")
    return ArchiveReader::format_of(path) == start_format ? inspect_start(path) : inspect_checkpoint(path);
  if (is_ply(path)) return inspect_ply(path);
  Model model = read_model(path);
  if (model.triangles.empty()) return inspect_cloud(moving_cloud(std::move(model), path.string()));
  return inspect_mesh(path.string(), model);
}

}  // namespace dreampm
