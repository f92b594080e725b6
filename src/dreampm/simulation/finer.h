// The same matter with eight times the particles.
#pragma once
#include <filesystem>

#include "dreampm/backend/motion.h"
#include "dreampm/model/scene.h"
#include "dreampm/setup/assemble.h"
#include "dreampm/state/world.h"

namespace dreampm {

/// Writes a moment of `scene` (setup/start.h) that has eight particles for each one of
/// `coarse`, which is of the same scene at twice the spacing. They lie in the middles of the
/// eighths of the cube that it takes, deformed as it is, at its state, its velocity and the
/// velocity's change over the cube: mass and momentum stay. What would lie behind a wall or in a
/// collider is moved out of it.
/// `scene_file` names the scene in messages. Throws InputError where there is no memory for them.
template <class R>
void write_finer(const std::filesystem::path& file, const World<R>& coarse, const Motion<R>& motion,
                 const model::Scene& scene, const std::string& scene_file, const ExpectedSpeed& expected);

}  // namespace dreampm
