// The looks of a scene's matter and colliders: what render/from_scene.h knows, with the colors that
// bodies bring.
#pragma once
#include <list>
#include <span>

#include "dreampm/io/ply.h"
#include "dreampm/io/run_record.h"
#include "dreampm/pose.h"
#include "dreampm/render/from_scene.h"

namespace dreampm {

/// The look of a material. One whose bodies all have one color takes that.
RenderLook material_look(const SceneDescription& scene, int material);

/// Have the material's bodies different colors? (Those without one have the look's.)
bool many_colored(const SceneDescription& scene, int material);

/// Linear color of each particle of the material, in the frame's order, from the body that it came
/// from. `bodies` as in run.json.
std::vector<Vec3f> particle_colors(const SceneDescription& scene, int material, const ParticleFrame& frame,
                                   const std::vector<BodyRecord>& bodies);

/// Color of each vertex from the particles around it, the nearer the more; `otherwise` where none
/// is near.
std::vector<Vec3f> vertex_colors(const TriMesh& mesh, std::span<const Vec3f> positions, std::span<const Vec3f> colors,
                                 float spacing, const Vec3f& otherwise);

/// Meshes of the colliders with their looks. `shift`: as render_scene; `poses`: where they stand;
/// empty: where the scene puts them.
struct DrawnColliders {
  std::list<TriMesh> meshes;
  std::vector<RenderObject> objects;
};
DrawnColliders drawn_colliders(const SceneDescription& scene, const Vec3d& shift, std::span<const Pose> poses = {});

}  // namespace dreampm
