// Reads what is in a tank: what can be set, what there is by name, what particles carry, and what a
// ray from above meets.
#include <dreampm/queries.h>
#include <dreampm/simulation.h>

#include <cstdio>

constexpr const char* scene = R"(
dreampm: 1
name: tank
space: {min: [0, 0, 0], max: [0.4, 0.4, 0.2], spacing: 0.02}
materials: {water: {type: newtonian, preset: water}}
bodies:
  pool: {material: water, shape: {box: {min: [0, 0, 0], max: [0.4, 0.16, 0.2]}}, cut: [crate]}
rigid:
  crate: {shape: {box: {size: [0.1, 0.1, 0.1]}}, density: 400, position: [0.2, 0.16, 0.1]}
)";

int main() try {
  dreampm::Simulation simulation(dreampm::parse_scene(scene, "tank"));
  simulation.set_wall(dreampm::Side::x_max, {dreampm::WallType::separate, 0.2});
  simulation.advance_to(1);

  const dreampm::Names names = simulation.names();
  std::printf("%zu particles of %s, %zu rigid body\n", simulation.particle_count(), names.materials[0].c_str(),
              names.rigid.size());
  for (const dreampm::Parameter& p : simulation.parameters("water"))
    if (p.key == "viscosity")
      std::printf("viscosity %g Pa s, from %g to %g; sound at %.3g m/s\n", p.value, p.min, p.max,
                  simulation.material("water").sound_speed);
  std::printf("gravity %g m/s^2, the wall x_max with friction %g, cells of %g m\n", simulation.gravity().y,
              simulation.wall(dreampm::Side::x_max).friction, simulation.stepping().cell);

  const dreampm::ParticleView water = simulation.particles("water");
  const dreampm::AttributeView pressure = simulation.attribute("water", "pressure");
  double deep = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < water.size(); ++i)
    if (water.position[i].y < 0.04f) deep += static_cast<double>(pressure.values[i]), ++count;
  std::printf("near the floor the water presses with %.0f Pa\n", deep / static_cast<double>(count));

  const auto hit = dreampm::cast_ray(simulation, {0.2, 0.39, 0.1}, {0, -1, 0});
  std::printf("from above one sees: %s\n", hit ? hit->name.c_str() : "nothing");
  return hit && hit->name == "crate" ? 0 : 1;
} catch (const dreampm::Error& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return e.exit_code();
}
