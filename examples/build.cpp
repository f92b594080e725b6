// A scene built of structs, without a scene file: a crate and a tap over a pool of honey, in which
// the water of the tap spreads.
#include <dreampm/simulation.h>

#include <cstdio>

using namespace dreampm;

/// A tank of 40 cm with a pool of honey, a tap of water above it, and a crate that floats.
model::Scene tank() {
  model::Scene scene;
  scene.name = "tank";
  scene.space = {.max = {0.4, 0.4, 0.4}, .spacing = 0.01};
  scene.time.frames = 25;
  scene.materials = {{"honey", "newtonian", preset("newtonian", "honey")},
                     {"water", "newtonian", preset("newtonian", "water")}};
  // Softer sound, longer steps.
  for (model::Material& m : scene.materials) m.values.set("max_compression", 0.03);
  scene.bodies = {{"pool", "honey", Shape::box({0, 0, 0}, {0.4, 0.1, 0.4})}};
  scene.emitters = {{.name = "tap",
                     .material = "water",
                     .shape = Shape::cylinder({0.1, 0.36, 0.1}, 0.03, 0.02),
                     .velocity = Vec3d{0, -1, 0},
                     .pool = 20000}};
  scene.colliders = {{.name = "crate",
                      .shape = Shape::box({0.22, 0.12, 0.22}, {0.32, 0.22, 0.32}).turned({0, 1, 0}, 20),
                      .friction = 0.4,
                      .rigid = model::Rigid{.density = 400}}};
  scene.probes = {{"crate", 0, PoseProbe{"crate"}}};
  scene.render.looks["crate"] = model::Look::wood();
  return scene;
}

int main() try {
  model::Scene wrong = tank();
  wrong.bodies[0].material = "hony";
  for (const std::string& line : check(wrong)) std::printf("refused: %s\n", line.c_str());

  Simulation simulation{Scene(tank())};
  for (int i = 1; i <= 5; ++i) {
    simulation.advance_to(0.1 * i);
    std::printf("t = %.2f s: %6zu particles of water, the crate at %.3f m\n", simulation.time(),
                simulation.particle_count("water"), simulation.collider("crate").twist.center.y);
  }
} catch (const Error& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return e.exit_code();
}
