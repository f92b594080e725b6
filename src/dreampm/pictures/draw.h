// A frame's surfaces and its picture, from files or from a simulation in memory.
#pragma once
#include <functional>
#include <vector>

#include "dreampm/foam/foam.h"
#include "dreampm/io/ply.h"
#include "dreampm/io/run_record.h"
#include "dreampm/pictures/render_scene.h"
#include "dreampm/surface/surface.h"

namespace dreampm {

/// Materials that are drawn as a mesh, as numbers; the others are drawn as spheres.
std::vector<int> meshed_materials(const model::Scene& scene);

/// The particles of one material in a frame, in its order.
struct MaterialParticles {
  std::vector<Vec3f> position;  ///< m, from the frame's shift
  std::vector<Vec3f> velocity;  ///< m/s, or empty
};
MaterialParticles particles_of(const model::Scene& scene, int material, const ParticleFrame& frame);

/// What `reconstruct` wraps, beside colliders as they stand. `particles` is borrowed.
SurfaceInput surface_input(const model::Scene& scene, const MaterialParticles& particles, const Vec3d& shift,
                           std::vector<WettedSolid> solids);
/// As the scene's section `surface` says.
SurfaceSettings surface_settings(const model::Scene& scene);

/// What a picture shows.
struct FrameContent {
  std::function<const ParticleFrame&()> particles;  ///< asked for only where a look needs them
  std::function<TriMesh(int material)> mesh;        ///< of a material of meshed_materials()
  std::function<FoamParticles()> foam{};            ///< of a scene with foam; or none
};

/// `shift`: where places of the content count from. `bodies`: as in run.json. What is cut is drawn
/// as at an instant, whatever the shutter.
Picture draw_frame(const model::Scene& scene, const Vec3d& shift, const std::vector<BodyRecord>& bodies,
                   const FrameContent& content, const DrawnColliders& colliders, const RenderSettings& settings);

}  // namespace dreampm
