// A description written back: the resolved scene of a run, and identities of its parts.
#pragma once
#include <string>

#include "dreampm/model/scene.h"

namespace dreampm::scene {

/// The scene as YAML with every value explicit and no variants. Numbers read back exactly:
/// parse_scene_text(write_scene(d)) gives d again.
std::string write_scene(const model::Scene& scene);

/// "[x, y, z]", which a scene reads back exactly.
std::string yaml_list(const Vec3d& v);

/// The parts of a run that can be redone on their own. Each hash covers what decides that part, the
/// parts before it included: surface and render those of the simulation, video those of the render.
enum class Part {
  simulation,  ///< all that decides the state: space, time, gravity, fields, seed, materials, bodies, colliders, files
               ///< they name
  particles,   ///< attributes that are written, and the probes
  foam,        ///< the foam alone
  surface,
  render,
  video
};

/// 16 hexadecimal digits, equal for scenes that give the same result. Not covered: name, about,
/// output.folder, how often checkpoints are written, surface.format and
/// render.format (files beside the same),
/// time.frames (more frames continue a run), where meshes lie (their bytes count). `simulation`:
/// the hash of that part as a run's record has it. The parts from surface on then need no model
/// file.
std::string scene_hash(const model::Scene& scene, Part part, const std::string& simulation = {});

/// The same for what one of the scene's probes measures.
std::string probe_hash(const model::Scene& scene, const model::Probe& probe);

}  // namespace dreampm::scene
