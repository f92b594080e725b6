#include "dreampm/pictures/draw.h"

#include <algorithm>
#include <list>

#include "dreampm/math/look_color.h"
#include "dreampm/pictures/absorption_of.h"
#include "dreampm/pictures/foam_grains.h"

namespace dreampm {
namespace {

const model::Look& look_of(const model::Scene& scene, int material) {
  return scene.render.looks.at(scene.materials[static_cast<std::size_t>(material)].name);
}

/// The panes of a basin have no thickness: matter that reaches into its walls ends at them.
void end_at_walls(TriMesh& mesh, const RenderScene& scene) {
  for (Vec3f& v : mesh.vertices)
    for (int a = 0; a < 3; ++a) {
      const auto low = static_cast<std::size_t>(2 * a);
      if (scene.is_wall[low]) v[a] = std::max(v[a], scene.basin.min[a]);
      if (scene.is_wall[low + 1]) v[a] = std::min(v[a], scene.basin.max[a]);
    }
}

}  // namespace

std::vector<int> meshed_materials(const model::Scene& scene) {
  std::vector<int> list;
  for (int m = 0; m < static_cast<int>(scene.materials.size()); ++m)
    if (look_of(scene, m).type != model::LookType::spheres) list.push_back(m);
  return list;
}

MaterialParticles particles_of(const model::Scene& scene, int material, const ParticleFrame& frame) {
  const std::string& name = scene.materials[static_cast<std::size_t>(material)].name;
  MaterialParticles out;
  for (std::size_t i = 0; i < frame.size(); ++i)
    if (frame.material_names.at(frame.material[i]) == name) {
      out.position.push_back(frame.position[i]);
      if (!frame.velocity.empty()) out.velocity.push_back(frame.velocity[i]);
    }
  return out;
}

SurfaceInput surface_input(const model::Scene& scene, const MaterialParticles& particles, const Vec3d& shift,
                           std::vector<WettedSolid> solids) {
  SurfaceInput input;
  input.positions = particles.position;
  input.velocities = particles.velocity;
  input.spacing = static_cast<float>(scene.space.spacing);
  input.walls = {static_cast<Vec3f>(scene.space.min - shift), static_cast<Vec3f>(scene.space.end() - shift)};
  for (std::size_t w = 0; w < 6; ++w) input.is_wall[w] = scene.space.walls[w].type != WallType::open;
  input.solids = std::move(solids);
  input.origin = shift;
  return input;
}

SurfaceSettings surface_settings(const model::Scene& scene) {
  const auto spacing = static_cast<float>(scene.space.spacing);
  SurfaceSettings settings;
  // The scene's bounds, an eighth of the spacing to twice it, are those of a float here.
  settings.voxel = std::clamp(static_cast<float>(scene.surface.voxel * scene.space.dx()), spacing / 8, 2 * spacing);
  settings.smooth = scene.surface.smooth;
  settings.overlap = static_cast<float>(scene.surface.overlap);
  settings.keep_field = scene.surface.type == model::SurfaceType::fog;
  return settings;
}

Picture draw_frame(const model::Scene& scene, const Vec3d& shift, const std::vector<BodyRecord>& bodies,
                   const FrameContent& content, const DrawnColliders& colliders, const RenderSettings& settings) {
  RenderScene out = render_scene(scene, shift);
  out.objects = colliders.objects;
  // What the picture borrows.
  std::list<TriMesh> meshes;
  std::list<std::vector<Vec3f>> arrays;
  std::list<AbsorptionField> fields;
  for (int m = 0; m < static_cast<int>(scene.materials.size()); ++m) {
    const model::Look& look = look_of(scene, m);
    const bool spheres = look.type == model::LookType::spheres, many = many_colored(scene, m),
               clear = look.type == model::LookType::dielectric, colored = many && !clear;
    std::vector<Vec3f>&positions = arrays.emplace_back(), &colors = arrays.emplace_back(),
    &velocities = arrays.emplace_back();
    const AbsorptionField* absorption = nullptr;
    if (spheres || many) {
      const ParticleFrame& frame = content.particles();
      MaterialParticles particles = particles_of(scene, m, frame);
      positions = std::move(particles.position), velocities = std::move(particles.velocity);
      if (many) colors = particle_colors(scene, m, frame, bodies);
      if (clear && is_clear(look) && !positions.empty())
        absorption = &fields.emplace_back(absorption_field(positions, colors, static_cast<float>(scene.space.spacing)));
      if (clear) colors.clear();
    }
    const auto cut = cut_of(scene, scene.materials[static_cast<std::size_t>(m)].name, shift);
    if (spheres) {
      if (cut) cut_points(positions, {&colors, &velocities}, *cut);
      const float radius = static_cast<float>(look.radius * scene.space.spacing);
      if (!positions.empty())
        out.objects.push_back({RenderSpheres{positions, radius, colors, velocities}, material_look(scene, m), {}});
      continue;
    }
    TriMesh& mesh = meshes.emplace_back(content.mesh(m));
    if (mesh.triangles.empty()) continue;
    end_at_walls(mesh, out);
    if (colored)
      colors = vertex_colors(mesh, positions, colors, static_cast<float>(scene.space.spacing), mixing_of(look));
    if (cut) cut_mesh(mesh, colors, *cut);
    out.objects.push_back({&mesh, material_look(scene, m), colors});
    out.objects.back().absorption = absorption;
  }
  FoamGrains grains;
  if (scene.foam && content.foam) {
    grains = foam_grains(scene, shift, content.foam(), settings);
    out.objects.push_back(grains.object());
  }
  return render_picture(out, settings);
}

}  // namespace dreampm
