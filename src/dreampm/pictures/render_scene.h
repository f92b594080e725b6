// The looks of a scene's matter and colliders: what render/from_scene.h knows, with the colors that
// bodies bring.
#pragma once
#include <list>
#include <map>
#include <memory>
#include <span>
#include <string>

#include "dreampm/io/ply.h"
#include "dreampm/io/run_record.h"
#include "dreampm/math/pigments.h"
#include "dreampm/render/cut.h"
#include "dreampm/render/from_scene.h"
#include "dreampm/setup/in_time.h"

namespace dreampm {

/// The look of a material. One whose bodies all have one color takes that.
model::Look material_look(const model::Scene& scene, int material);

/// Have the material's bodies and emitters different colors? (Bodies without one have the look's;
/// emitters without one do not count.)
bool many_colored(const model::Scene& scene, int material);

/// Linear color of the material's matter: the one that all of it has, else that of its look.
Vec3f matter_color(const model::Scene& scene, int material);

/// The colors that bodies and emitters have of their own, linear. `bodies` as in run.json.
class MatterColors {
 public:
  MatterColors(const model::Scene& scene, const std::vector<BodyRecord>& bodies);
  /// That of the body or the emitter of the frame's i-th particle; null where it has none, and for
  /// matter of neither. Throws InputError where an emitter has one and the frame lacks the column
  /// `source`.
  const Vec3f* of(const ParticleFrame& frame, std::size_t i) const;

 private:
  struct Range {
    std::uint64_t first, end;
    Vec3f color;
  };
  std::vector<Range> ranges_;  ///< ascending ids: bodies are numbered one after the other
  std::map<std::string, Vec3f> emitters_;
};

/// Linear color of each particle of the material, in the frame's order, from the body or the
/// emitter that it came from. `bodies` as in run.json.
std::vector<Vec3f> particle_colors(const model::Scene& scene, int material, const ParticleFrame& frame,
                                   const std::vector<BodyRecord>& bodies);

/// Color of each vertex: those of the particles around it, mixed as that matter mixes them
/// (math/pigments.h), the nearer the more. Meshes without vertices need no
/// particles.
std::vector<Vec3f> vertex_colors(const TriMesh& mesh, std::span<const Vec3f> positions, std::span<const Vec3f> colors,
                                 float spacing, Mixing mixing);
/// How the colors of matter of that look mix.
Mixing mixing_of(const model::Look& look);

/// The plane of the scene's cut, if the thing of that name is cut.
std::optional<CutPlane> cut_of(const model::Scene& scene, const std::string& name, const Vec3d& shift);

/// Colliders of a picture.
struct DrawnColliders {
  std::list<TriMesh> meshes;
  std::list<TriMesh> steps{};  ///< of the way of those that move while the picture is exposed
  std::vector<RenderObject> objects;
};

/// Where colliders are within an exposure.
struct ColliderMotion {
  double open = 0;                       ///< s, that it lasts; 0: an instant
  std::vector<std::vector<Pose>> poses;  ///< at even times from its beginning to its end, a pose each
};

/// Meshes of a scene's colliders with their looks, made once. `shift`: as render_scene.
class ColliderModels {
 public:
  ColliderModels(const model::Scene& scene, const Vec3d& shift);
  std::size_t size() const { return models_.size(); }
  const std::string& name(std::size_t collider) const { return models_[collider].in_time.name(); }
  const model::Look& look(std::size_t collider) const { return models_[collider].look; }
  /// Whether its mesh is another at other times.
  bool deforms(std::size_t collider) const { return models_[collider].in_time.sequence() != nullptr; }
  /// Its mesh, uncut, as the scene gives it; at a time [s] if it deforms. Empty of a pin.
  TriMesh mesh(std::size_t collider, double time = 0) const;
  /// The same, without what lies beyond the box where it stands, if pictures do not show that: a
  /// wall that a hand dragged ends at the box.
  TriMesh mesh_within(std::size_t collider, const Pose& pose) const;
  /// Where they stand in a frame.
  std::vector<Pose> poses_in(const FrameRecord& frame) const;
  /// The same through an exposure of `open` seconds about the frame. Between frames rigid bodies
  /// turn and go on evenly. `before`, `after`: the frames next to it, or null.
  ColliderMotion motion_about(const FrameRecord& frame, const FrameRecord* before, const FrameRecord* after,
                              double open) const;
  /// Them where they stand, a pose each, at a time [s], and cut where the scene asks for it. What
  /// is cut does not move with `motion`.
  DrawnColliders at(std::span<const Pose> poses, double time, const ColliderMotion& motion = {}) const;

 private:
  struct Model {
    ColliderInTime in_time;
    TriMesh mesh;  ///< of one that does not deform
    model::Look look;
    TextureFrame frame;  ///< at rest
    std::optional<CutPlane> cut;
    std::optional<Box3d> within{};  ///< m, from the shift: what is beyond is not drawn
  };
  Vec3f placed(const Pose& pose, const Vec3f& p) const {
    return static_cast<Vec3f>(pose(static_cast<Vec3d>(p) + shift_) - shift_);
  }

  /// Its mesh where it stands, uncut.
  TriMesh standing(std::size_t collider, const Pose& pose, double time) const;
  /// Gives a mesh its velocities, and its object the steps of its way.
  void add_motion(std::size_t collider, double time, const ColliderMotion& motion, TriMesh& mesh, RenderObject& object,
                  std::list<TriMesh>& steps) const;

  std::vector<Model> models_;
  Vec3d shift_;
};

}  // namespace dreampm
