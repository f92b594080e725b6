#include "dreampm/pipeline/surface_stage.h"

#include <algorithm>

#include "dreampm/base/error.h"
#include "dreampm/base/hash.h"
#include "dreampm/base/log.h"
#include "dreampm/io/numbered.h"
#include "dreampm/io/ply.h"
#include "dreampm/pictures/surface_attributes.h"
#include "dreampm/pictures/wetted_solids.h"
#include "dreampm/scene/emit.h"
#include "dreampm/surface/resting_drops.h"
#include "dreampm/surface/vdb.h"
#include "dreampm/surface/volume_taken.h"

namespace dreampm {
namespace fs = std::filesystem;
namespace {

/// What names a level set beside the fog of the same surface.
constexpr const char* distances = "-sdf";

std::string stem_of(const RunFolder& run, int material) {
  const bool several = meshed_materials(run.scene).size() > 1;
  return several ? run.scene.materials[std::size_t(material)].name : "surface";
}

/// The volume beside the mesh, of a scene that asks for one.
fs::path volume_file(const RunFolder& run, int material, int frame) {
  const std::string kind = run.scene.surface.type == model::SurfaceType::sdf ? distances : "";
  return run.folder / "surface" / numbered(stem_of(run, material) + kind, frame, ".vdb");
}

std::string settings_hash(const RunFolder& run) {
  Hash64 hash;
  hash.add(std::string_view(scene::scene_hash(run.scene, scene::Part::surface, run.record.scene_hash)));
  // Which materials are meshed follows from their looks.
  for (const int m : meshed_materials(run.scene)) hash.add(std::string_view(run.scene.materials[std::size_t(m)].name));
  return hash.hex();
}

/// What a frame's meshes could be called, whichever materials were meshed and whichever format was
/// asked for.
std::vector<fs::path> possible_files(const RunFolder& run, int frame) {
  std::vector<fs::path> files;
  std::vector<std::string> stems{"surface"};
  for (const model::Material& m : run.scene.materials) stems.push_back(m.name);
  for (const std::string& stem : stems) {
    for (const char* extension : {".ply", ".obj", ".vdb"})
      files.push_back(run.folder / "surface" / numbered(stem, frame, extension));
    files.push_back(run.folder / "surface" / numbered(stem + distances, frame, ".vdb"));
  }
  return files;
}

void record_volume(RunFolder& run, const VolumeRecord& v) {
  auto& list = run.record.stages["surface"].volumes;
  std::erase_if(list, [&](const VolumeRecord& o) { return o.frame == v.frame && o.material == v.material; });
  const auto place =
      std::upper_bound(list.begin(), list.end(), v, [](const auto& a, const auto& b) { return a.frame < b.frame; });
  list.insert(place, v);
}

/// Forgets what is no longer there.
void keep_volumes(RunFolder& run, const std::vector<int>& frames, const std::vector<int>& materials) {
  std::erase_if(run.record.stages["surface"].volumes, [&](const VolumeRecord& v) {
    return std::find(frames.begin(), frames.end(), v.frame) == frames.end() ||
           std::none_of(materials.begin(), materials.end(),
                        [&](int m) { return run.scene.materials[std::size_t(m)].name == v.material; });
  });
}

/// The drops of each material that dry up, in a scene that asks for it.
class DryingDrops {
 public:
  explicit DryingDrops(const RunFolder& run) : run_(run) {}
  /// One share a particle of the material, or none.
  std::vector<float> remaining(int material, int number, const ParticleFrame& frame) {
    const auto& surface = run_.scene.surface;
    if (!surface.drop_life) return {};
    const auto drops = of_material_.try_emplace(material, static_cast<float>(run_.scene.space.spacing),
                                                *surface.drop_life, run_.record.frames.front().frame,
                                                [this, material](int f) { return liquid(material, f); });
    number_ = number, frame_ = &frame;
    return drops.first->second.remaining(number);
  }

 private:
  surface::LiquidFrame liquid(int material, int number) const {
    const ParticleFrame read = number == number_ ? ParticleFrame{} : read_particles(run_.particles(number));
    const ParticleFrame& frame = number == number_ ? *frame_ : read;
    const std::string& name = run_.scene.materials[static_cast<std::size_t>(material)].name;
    surface::LiquidFrame out{run_.frame_record(number).time, {}, {}};
    for (std::size_t i = 0; i < frame.size(); ++i) {
      if (frame.material_names.at(frame.material[i]) != name) continue;
      out.ids.push_back(frame.id[i]), out.positions.push_back(frame.position[i]);
    }
    return out;
  }

  const RunFolder& run_;
  std::map<int, surface::RestingDrops> of_material_;
  int number_ = 0;  ///< of the frame that is at hand
  const ParticleFrame* frame_ = nullptr;
};

void make_surface(RunFolder& run, const ParticleFrame& frame, const std::vector<WettedSolid>& solids,
                  const std::vector<float>& remaining, int material, int number) {
  const model::Scene& scene = run.scene;
  const MaterialParticles particles = particles_of(scene, material, frame);
  SurfaceInput input = surface_input(scene, particles, frame.shift, solids);
  input.remaining = remaining;
  const SurfaceSettings settings = surface_settings(scene);
  SurfaceResult result = reconstruct(input, settings);
  const VertexAttributes attributes =
      surface_attributes(scene, material, frame, result.mesh, run.record.bodies, run.particles(number).string());
  if (!has_surface_attribute(scene, "velocity")) result.mesh.velocities.clear();
  if (result.field) write_fog_vdb(volume_file(run, material, number), *result.field, frame.shift);
  if (scene.surface.type == model::SurfaceType::sdf)
    write_level_set_vdb(volume_file(run, material, number), result.mesh, settings.voxel, frame.shift);
  if (scene.surface.format == model::SurfaceFormat::obj)
    write_obj(surface_file(run, material, number, ".obj"), result.mesh, frame.shift, si_note, attributes);
  write_mesh(surface_file(run, material, number), result.mesh, frame.shift, si_note, attributes);
  const double spacing = scene.space.spacing;
  record_volume(run, {number, scene.materials[std::size_t(material)].name,
                      static_cast<double>(particles.position.size()) * spacing * spacing * spacing, result.volume,
                      volume_taken(input)});
}

}  // namespace

fs::path surface_file(const RunFolder& run, int material, int frame, const std::string& extension) {
  return run.folder / "surface" / numbered(stem_of(run, material), frame, extension);
}

std::function<Identity(int frame)> surface_identity(const RunFolder& run) {
  return [&run, simulation = run.record.scene_hash, settings = settings_hash(run)](int frame) -> Identity {
    Hash64 state;
    state.add(std::string_view(simulation));
    state.add(std::string_view(run.state_hash(frame)));
    return {{"simulation", state.hex()}, {"surface settings", settings}};
  };
}

std::string no_surface(const RunFolder& run, const std::vector<int>& frames) {
  return not_up_to_date(run, "surface", frames, surface_identity(run));
}

std::vector<std::string> volume_lines(const RunRecord& record) {
  const auto stage = record.stages.find("surface");
  if (stage == record.stages.end()) return {};
  struct Worst {
    double off = 0;
    int frame = 0;
    void add(double value, int at) {
      if (frame == 0 || std::abs(value) > std::abs(off)) off = value, frame = at;
    }
    std::string text() const { return fmt::format("{:+.1f} % (frame {})", 100 * off, frame); }
  };
  // A mesh is compared with what its particles take; at rest, where a record of an earlier version
  // does not say it.
  const auto swollen = [](const VolumeRecord& v) { return v.taken.value_or(v.particles) / v.particles - 1; };
  const auto mesh_off = [](const VolumeRecord& v) { return v.mesh / v.taken.value_or(v.particles) - 1; };
  struct Of {
    std::string material;
    VolumeRecord first;
    Worst swollen, mesh;
  };
  std::vector<Of> of;  // in the order of the scene
  for (const VolumeRecord& v : stage->second.volumes) {
    if (!(v.particles > 0)) continue;
    auto known = std::find_if(of.begin(), of.end(), [&](const Of& o) { return o.material == v.material; });
    if (known == of.end()) known = of.insert(of.end(), {v.material, v, {}, {}});
    known->swollen.add(swollen(v), v.frame), known->mesh.add(mesh_off(v), v.frame);
  }
  std::vector<std::string> lines;
  for (const Of& o : of)
    lines.push_back(
        o.first.taken
            ? fmt::format("{}: at frame {} the particles take {:+.1f} % of their rest volume; the mesh "
                          "{:+.1f} % of that. Farthest off: particles {}, mesh {}",
                          o.material, o.first.frame, 100 * swollen(o.first), 100 * mesh_off(o.first), o.swollen.text(),
                          o.mesh.text())
            : fmt::format("{}: at frame {} the mesh {:+.1f} % of its particles' rest volume. Farthest off: {}",
                          o.material, o.first.frame, 100 * mesh_off(o.first), o.mesh.text()));
  return lines;
}

StageResult surface_stage(RunFolder& run, const FrameRange& frames) {
  const std::vector<int> materials = meshed_materials(run.scene);
  if (materials.empty()) return {};
  StageWork work;
  work.name = "surface";
  work.settings_hash = scene::scene_hash(run.scene, scene::Part::surface, run.record.scene_hash);
  work.frames = run.chosen(frames.first, frames.last);
  work.all_frames = frames.all();
  work.identity = surface_identity(run);
  work.products = [&](int f) {
    std::vector<fs::path> files;
    for (const int m : materials) {
      files.push_back(surface_file(run, m, f));
      if (run.scene.surface.format == model::SurfaceFormat::obj) files.push_back(surface_file(run, m, f, ".obj"));
      if (run.scene.surface.type != model::SurfaceType::mesh) files.push_back(volume_file(run, m, f));
    }
    return files;
  };
  DryingDrops drying(run);
  std::optional<WettedSolids> solids;  // read when the first frame asks for them
  work.make = [&](int f) {
    const ParticleFrame frame = read_particles(run.particles(f));
    if (!solids) solids.emplace(run.scene);
    const std::vector<WettedSolid> standing = solids->in(run.frame_record(f));
    for (const int m : materials) make_surface(run, frame, standing, drying.remaining(m, f, frame), m, f);
  };
  work.leftovers = [&](int f) { return possible_files(run, f); };
  if (work.all_frames) keep_volumes(run, work.frames, materials);
  const StageResult result = run_stage(run, work);
  if (result.made == 0) return result;
  const LogFile log(run.log_file());
  for (const std::string& line : volume_lines(run.record)) info("surface: {}", line);
  return result;
}

}  // namespace dreampm
