#include "dreampm/pipeline/surface_stage.h"

#include "dreampm/base/error.h"
#include "dreampm/base/hash.h"
#include "dreampm/base/log.h"
#include "dreampm/io/ply.h"
#include "dreampm/pipeline/simulate.h"
#include "dreampm/scene/emit.h"
#include "dreampm/surface/surface.h"
#include "dreampm/surface/vdb.h"

namespace dreampm {
namespace fs = std::filesystem;
namespace {

std::string settings_hash(const SceneDescription& scene) {
  Hash64 hash;
  hash.add(std::string_view(scene::scene_hash(scene, scene::Part::surface)));
  // Which materials are meshed follows from their looks.
  for (const int m : meshed_materials(scene)) hash.add(std::string_view(scene.materials[std::size_t(m)].name));
  return hash.hex();
}

void make_surface(const RunFolder& run, const ParticleFrame& frame, int material, int number) {
  const SceneDescription& scene = run.scene;
  const std::string& name = scene.materials[std::size_t(material)].name;
  std::vector<Vec3f> position, velocity;
  for (std::size_t i = 0; i < frame.size(); ++i)
    if (frame.material_names.at(frame.material[i]) == name) {
      position.push_back(frame.position[i]);
      if (!frame.velocity.empty()) velocity.push_back(frame.velocity[i]);
    }
  SurfaceInput input;
  input.positions = position;
  input.velocities = velocity;
  input.spacing = static_cast<float>(scene.space.spacing);
  input.walls = {static_cast<Vec3f>(scene.space.min), static_cast<Vec3f>(scene.space.max)};
  for (std::size_t w = 0; w < 6; ++w) input.is_wall[w] = scene.space.walls[w].type != scene::WallType::open;
  SurfaceSettings settings;
  settings.voxel = static_cast<float>(scene.surface.voxel * scene.space.dx());
  settings.smooth = scene.surface.smooth;
  settings.keep_field = scene.surface.format == scene::SurfaceFormat::vdb;
  const SurfaceResult result = reconstruct(input, settings);
  if (scene.surface.format == scene::SurfaceFormat::obj)
    write_obj(surface_file(run, material, number, ".obj"), result.mesh);
  if (result.field) write_vdb(surface_file(run, material, number, ".vdb"), *result.field);
  write_mesh(surface_file(run, material, number), result.mesh);
}

}  // namespace

std::vector<int> meshed_materials(const SceneDescription& scene) {
  std::vector<int> list;
  for (std::size_t m = 0; m < scene.materials.size(); ++m)
    if (scene.render.looks.at(scene.materials[m].name).type != scene::LookType::spheres)
      list.push_back(static_cast<int>(m));
  return list;
}

fs::path surface_file(const RunFolder& run, int material, int frame, const std::string& extension) {
  const bool several = meshed_materials(run.scene).size() > 1;
  const std::string stem = several ? run.scene.materials[std::size_t(material)].name : "surface";
  return run.folder / "surface" / numbered(stem, frame, extension);
}

std::function<Identity(int frame)> surface_identity(const RunFolder& run) {
  const std::string simulation = scene::scene_hash(run.scene, scene::Part::simulation);
  return [&run, simulation, settings = settings_hash(run.scene)](int frame) -> Identity {
    Hash64 state;
    state.add(std::string_view(simulation));
    state.add(std::string_view(run.state_hash(frame)));
    return {{"simulation", state.hex()}, {"surface settings", settings}};
  };
}

StageResult surface_stage(RunFolder& run) {
  const std::vector<int> materials = meshed_materials(run.scene);
  if (materials.empty()) return {};
  StageWork work;
  work.name = "surface";
  work.settings_hash = scene::scene_hash(run.scene, scene::Part::surface);
  work.frames = run.frames();
  work.identity = surface_identity(run);
  work.products = [&](int f) {
    std::vector<fs::path> files;
    for (const int m : materials) {
      files.push_back(surface_file(run, m, f));
      if (run.scene.surface.format == scene::SurfaceFormat::obj) files.push_back(surface_file(run, m, f, ".obj"));
      if (run.scene.surface.format == scene::SurfaceFormat::vdb) files.push_back(surface_file(run, m, f, ".vdb"));
    }
    return files;
  };
  work.make = [&](int f) {
    const ParticleFrame frame = read_particles(run.particles(f));
    for (const int m : materials) make_surface(run, frame, m, f);
  };
  return run_stage(run, work);
}

}  // namespace dreampm
