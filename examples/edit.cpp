// Changes a simulation while it runs: water turns to honey, gravity turns, a ball is dropped in, a
// corner is emptied.
#include <dreampm/simulation.h>

#include <cstdio>

constexpr const char* scene = R"(
dreampm: 1
name: edit
space: {min: [0, 0, 0], max: [0.4, 0.4, 0.2], spacing: 0.01}
materials:
  liquid: {type: newtonian, preset: water}
  rubber: {type: neo_hookean, youngs_modulus: 2.0e4, poissons_ratio: 0.4}
bodies:
  dam: {material: liquid, shape: {box: {min: [0, 0, 0], max: [0.15, 0.25, 0.2]}}}
)";

void print(const char* what, const dreampm::Simulation& simulation) {
  const dreampm::Totals t = simulation.totals();
  std::printf("t = %.3f s, %-12s: %llu particles, %.3f kg, kinetic energy %.3f J\n", simulation.time(), what,
              static_cast<unsigned long long>(t.particles), t.mass, t.kinetic);
}

int main() try {
  dreampm::Simulation simulation(dreampm::parse_scene(scene, "edit"));
  simulation.advance_to(0.2);
  print("water", simulation);

  simulation.set_parameter("liquid", "viscosity", 8.5);  // Pa s: honey
  simulation.advance_to(0.5);
  print("honey", simulation);

  simulation.add({"ball", "rubber", dreampm::Shape::sphere({0.3, 0.3, 0.1}, 0.05), {0, -1, 0}});
  simulation.set_gravity({-3, -9, 0});
  simulation.advance_to(0.8);
  print("with a ball", simulation);

  const std::size_t taken = simulation.remove(dreampm::Shape::box({0, 0, 0}, {0.1, 0.4, 0.2}));
  std::printf("%zu particles taken out\n", taken);
  simulation.advance_to(1.0);
  print("flows back", simulation);

  try {
    simulation.set_parameter("liquid", "viscosity", -1);
  } catch (const dreampm::InputError& e) {
    std::printf("refused: %s\n", e.what());
  }
} catch (const dreampm::Error& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return e.exit_code();
}
