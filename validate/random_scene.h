// Random scenes for the case stability: two bodies of any materials fall on a floor and on each
// other.
#pragma once
#include <cstdint>
#include <string>

#include "dreampm/model/scene.h"
#include "dreampm/physics/dt.h"

namespace dreampm::validate {

/// A scene by chance, and what its run is held to.
struct RandomScene {
  std::string text;  ///< the scene, for `dreampm run`
  model::Scene scene;
  double fall = 0;  ///< m/s, of matter that fell from the draw's height, at most 1 m, and through its room or out of it
  double dt_floor = 0;  ///< s, no step may be shorter
};

/// s: the shortest step that stable_dt gives to anything no faster, stiffer or more viscous than
/// `most`, with as many contacts. Less speed or stiffness never shortens it. Less viscosity does
/// where viscosity becomes explicit: one more stage is one that reaches farther, but explicit steps
/// last as long as they cost no more than the fewest stages that can ever pay. They are no shorter
/// then than wave_bound over what those cost.
double shortest_dt(double cfl, double dx, const SignalSpeeds& most);

inline constexpr int random_scene_steps = 400;  ///< steps of a draw: sound crosses its room several times

/// RandomScene `index` of `seed` of the report's program: one of its two presets, its sliders
/// anywhere in their ranges (v, lower, upper, elastic, h, gravity along each axis), on its grid of
/// 32 or, one in eight, of 64. Bodies begin at rest; `fall` is the speed of matter that fell
/// through the whole box.
RandomScene random_report_scene(std::uint64_t seed, int index);

/// RandomScene `index` of `seed`: materials of the list with every parameter anywhere in its range
/// (log-uniform where a slider moves in decades), densities of 1:10 at most, any cfl that the
/// parser takes, spacings of 1 mm to 0.1 m, 1 to 64 particles a cell, any transfer, any walls, one
/// in ten open, a collider in four of ten. Matter that is stiff takes steps too short to fall a
/// meter in a second of computing, so bodies begin less than a cell apart with the speed of that
/// fall. `dt_floor`: the step of matter at the highest speed that the fall can give. All its energy
/// in the lighter body makes that sqrt(mass of both/its own) times as fast as the fall, and a free
/// surface moves twice as fast as the wave that arrives at it; a small piece before a large one
/// leaves a wall at three times, so that four times count at least. Wave speed and viscosity are
/// those of materials that took up the energy of that speed, one load after another, also in steps
/// as coarse as it makes them (impact.h). Energy out of nothing, stiffness beyond what that energy
/// can make, and a step that shrinks on by itself all end below it. `cfl`: instead of the drawn
/// one, if not 0. What the parser would not take stands in `scene` alone; `text` has the largest
/// that it takes.
RandomScene random_scene(std::uint64_t seed, int index, double cfl = 0);

}  // namespace dreampm::validate
