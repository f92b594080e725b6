// Colliders that move: what they do to matter against exact solutions and balances, and that bits
// stay whatever threads and restarts do.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <numbers>

#include "dreampm/backend/cpu/cpu.h"
#include "dreampm/pipeline/checkpoint.h"
#include "dreampm/run/engine.h"
#include "dreampm/setup/assemble.h"
#include "dreampm/state/world_fields.h"
#include "scenes.h"

namespace dreampm {
namespace {
using namespace test;
using testing::HasSubstr;

/// A scene that steps, and what its first collider gave to the matter.
struct Moved : Observer {
  explicit Moved(const std::string& yaml)
      : start(assemble(parse_scene(yaml, "moving.yaml").model(), "moving.yaml")),
        engine(as_world<float>(start.world), make_cpu_backend("auto")) {
    engine.add(*this);
    engine.begin(start.seeds);
    first = balance(engine.world(), engine.motion());
  }
  void move(const Twist& twist) {
    engine.world().colliders.at(0).twist = twist;
    engine.form_grid();
  }
  double next_sample_time() const override { return always; }
  void on_step(const StepSums& s) override {
    given += s.grid.colliders.at(0);
    lost += s.pass.energy.viscous + s.pass.energy.plastic + s.pass.energy.relaxed + s.transfer;
    rounding += s.rounding;
    for (const ImpulseSum& w : s.grid.walls) walls += w;
    for (std::size_t c = 1; c < s.grid.colliders.size(); ++c) others += s.grid.colliders[c];
  }
  void until(double time) {
    while (engine.world().time < time - 1e-9) engine.step();
  }
  Balance now() const { return balance(engine.world(), engine.motion()); }
  Vec3d center() const {
    Vec3d sum;
    std::size_t n = 0;
    const World<float>& w = engine.world();
    for (const auto& set : w.sets)
      for (std::size_t b = 0; b + 1 < set.block_start.size(); ++b)
        for (std::size_t p = set.block_start[b]; p < set.block_start[b + 1]; ++p, ++n)
          sum += w.position(w.particle_blocks[b], {set.u[0][p], set.u[1][p], set.u[2][p]});
    return sum / static_cast<double>(n);
  }

  InitialState start;
  Engine<float> engine;
  Balance first;
  ImpulseSum given, walls, others;
  double lost = 0, rounding = 0;
};

std::string scene(const std::string& space, const std::string& material, const std::string& body,
                  const std::string& collider, const std::string& gravity = "[0, 0, 0]") {
  return "dreampm: 1\nname: moving\nspace: " + space + "\ntime: {fps: 100}\ngravity: " + gravity +
         "\nmaterials: {matter: " + material + "}\nbodies: {body: {material: matter, shape: " + body +
         "}}\ncolliders: {thing: " + collider + "}\n";
}

// Water that fills a box, compressed by a piston that fills its end: volume, pressure, and the work
// that becomes energy. Without relaxation, which follows the density that the grid measures.
TEST(MovingColliders, APistonCompressesWater) {
  constexpr double bulk = 1e6, speed = 1, length = 0.4, area = 0.1 * 0.1, way = 0.02;
  Moved run(scene("{min: [0, 0, 0], max: [0.5, 0.1, 0.1], spacing: 0.01}",
                  "{type: newtonian, density: 1000, viscosity: 0, bulk_modulus: 1.0e6, gamma: linear, relaxation: 0}",
                  "{box: {min: [0, 0, 0], max: [0.4, 0.1, 0.1]}}",
                  "{shape: {box: {min: [0.4, 0, 0], max: [0.5, 0.1, 0.1]}}, type: slip}"));
  run.move({{-speed, 0, 0}, {}, {}});
  run.until(way / speed);
  const Balance pressed = run.now();
  const double energy = pressed.kinetic + pressed.elastic - run.first.kinetic - run.first.elastic;
  std::printf("work %.4g J, energy %.4g J, lost %.4g J; impulse %.4g N s\n", run.given.work, energy, run.lost,
              run.given.impulse.x);
  EXPECT_NEAR(run.given.work, -speed * run.given.impulse.x, 1e-3 * run.given.work);
  EXPECT_NEAR(energy + run.lost, run.given.work, 0.02 * run.given.work);
  EXPECT_NEAR(pressed.volume, (length - way) * area, 0.01 * length * area);

  run.move({});
  run.given = {};
  const double from = run.engine.world().time, periods = 4 * 2 * length / std::sqrt(bulk / 1000);
  run.until(from + periods);
  const double pressure = -run.given.impulse.x / area / (run.engine.world().time - from),
               strain = 1 - run.now().volume / (length * area);
  std::printf("pressure %.4g Pa, of a strain of %.4g\n", pressure, strain);
  EXPECT_NEAR(pressure, bulk * strain, 0.05 * bulk * strain);
  EXPECT_NEAR(run.now().volume, (length - way) * area, 0.01 * length * area);
  EXPECT_EQ(run.given.work, 0);
}

// A viscous liquid between a plate that moves along itself and a wall: plane Couette flow.
TEST(MovingColliders, APlateThatSticksDragsALiquid) {
  constexpr double speed = 0.1, height = 0.2;
  Moved run(
      scene("{min: [0, 0, 0], max: [0.16, 0.26, 0.16], spacing: 0.01, periodic: [x, z], walls: {y_max: {type: stick}}}",
            "{type: newtonian, density: 1000, viscosity: 100, bulk_modulus: 1.0e5}",
            "{box: {min: [0, 0.06, 0], max: [0.16, 0.26, 0.16]}}",
            "{shape: {plane: {point: [0, 0.06, 0], normal: [0, 1, 0]}}, type: stick}"));
  run.move({{speed, 0, 0}, {}, {}});
  run.until(0.5);
  const World<float>& w = run.engine.world();
  const auto& set = w.sets[0];
  double worst = 0;
  for (std::size_t b = 0; b + 1 < set.block_start.size(); ++b)
    for (std::size_t p = set.block_start[b]; p < set.block_start[b + 1]; ++p) {
      const double y = w.position(w.particle_blocks[b], {set.u[0][p], set.u[1][p], set.u[2][p]}).y - 0.06;
      const double v = static_cast<double>(run.engine.motion().sets[0].velocity[p].x);
      worst = std::max(worst, std::abs(v / speed - (1 - y / height)));
    }
  std::printf("worst of the profile %.3g\n", worst);
  EXPECT_LT(worst, 0.05);
  EXPECT_NEAR(run.given.work, speed * run.given.impulse.x, 1e-3 * run.given.work);
}

// A jelly cube that flies onto a plate, and a plate that flies onto a cube at rest: the same but
// for where the grid lies.
TEST(MovingColliders, PhysicsIsTheSameInAMovingFrame) {
  constexpr double speed = 1;
  const auto yaml = [](const std::string& velocity) {
    std::string text = scene("{min: [0, 0, 0], max: [0.8, 0.32, 0.32], spacing: 0.01}",
                             "{type: neo_hookean, density: 1000, youngs_modulus: 1.0e5, poissons_ratio: 0.3}",
                             "{box: {min: [0.3, 0.1, 0.1], max: [0.42, 0.22, 0.22]}}",
                             "{shape: {box: {min: [0.1, 0.02, 0.02], max: [0.28, 0.3, 0.3]}}, friction: 0.3}");
    return text.replace(text.find("}}\ncolliders"), 2, ", velocity: " + velocity + "}}");
  };
  Moved flies(yaml("[-1, 0.2, 0]")), rests(yaml("[0, 0, 0]"));
  rests.move({{speed, -0.2, 0}, {}, {}});
  double most = 0;
  for (int frame = 1; frame <= 10; ++frame) {
    const double time = 0.01 * frame;
    flies.until(time), rests.until(time);
    const Vec3d apart = flies.center() + Vec3d{speed, -0.2, 0} * time - rests.center();
    most = std::max(most, length(apart));
  }
  std::printf("apart %.3g m; pushes %.5g and %.5g, rubs %.4g and %.4g N s\n", most, flies.given.impulse.x,
              rests.given.impulse.x, flies.given.impulse.y, rests.given.impulse.y);
  EXPECT_GT(flies.given.impulse.x, 0.12 * 0.12 * 0.12 * 1000 * speed);
  EXPECT_NEAR(rests.given.impulse.x, flies.given.impulse.x, 0.02 * flies.given.impulse.x);
  EXPECT_NEAR(rests.given.impulse.y, flies.given.impulse.y, 0.1 * std::abs(flies.given.impulse.y));
  EXPECT_LT(most, 0.1 * 0.02);
  // Momentum is what the plate gave; the cube meets no wall.
  const Vec3d gained = rests.now().momentum - rests.first.momentum;
  EXPECT_LT(length(gained - rests.given.impulse), 1e-4 * length(gained));
}

std::string paddle_in_water(const std::string& type) {
  return scene(
      "{min: [0, 0, 0], max: [0.4, 0.4, 0.2], spacing: 0.02}", "{type: newtonian, preset: water, bulk_modulus: 1.0e5}",
      "{box: {min: [0, 0, 0], max: [0.4, 0.12, 0.2]}}",
      "{shape: {box: {min: [0.04, 0.17, 0.04], max: [0.36, 0.23, 0.16]}}, type: " + type + "}", "[0, -9.81, 0]");
}
const Twist turning{{}, {0, 0, 6}, {0.2, 0.2, 0.1}};

// The work of a paddle is its torque times the angle, and no less than the energy that the water
// gains.
TEST(MovingColliders, APaddleDoesTheWorkOfItsTorque) {
  for (const std::string type : {"separate", "stick"}) {
    Moved run(paddle_in_water(type));
    run.move(turning);
    run.until(0.4);
    const Vec3d torque = run.given.angular - cross(turning.center, run.given.impulse);
    const Balance now = run.now();
    const double gained =
        now.kinetic + now.elastic + now.gravity - run.first.kinetic - run.first.elastic - run.first.gravity;
    std::printf("%s: work %.4g J, torque times angle %.4g J; energy %.4g J, lost %.4g J\n", type.c_str(),
                run.given.work, dot(torque, turning.spin), gained, run.lost);
    EXPECT_NEAR(run.given.work, dot(torque, turning.spin), 0.01 * run.given.work);
    EXPECT_GT(now.kinetic, 0.1);
    EXPECT_LT(gained + run.lost, run.given.work * 1.01);
    const Vec3d momentum = now.momentum - run.first.momentum - run.given.impulse - run.walls.impulse;
    EXPECT_NEAR(momentum.x, 0, 1e-3 * now.mass);
    EXPECT_NEAR(run.engine.world().colliders[0].pose.rotation.z, std::sin(0.5 * 6 * 0.4), 1e-6);
  }
}

TEST(MovingColliders, BitsDoNotDependOnThreadsSnapshotsOrCheckpoints) {
  const auto file = std::filesystem::temp_directory_path() / "dreampm_moving_checkpoint.dmc";
  const Scene of = parse_scene(paddle_in_water("separate"), "paddle.yaml");
  expect_same_bits(of, 0.06, 0.12, [](Simulation& s) { s.set_motion("thing", turning); }, [](Simulation&) {});
  Moved run(paddle_in_water("separate")), other(paddle_in_water("separate"));
  run.move(turning);
  run.until(0.1);
  CheckpointInfo info;
  info.scene_hash = "paddle";
  save_checkpoint(file, run.engine.world(), info);
  World<float> read = as_world<float>(other.start.world);
  load_checkpoint(file, "paddle", read);
  EXPECT_EQ(state_hash(read), state_hash(run.engine.world()));
  EXPECT_EQ(read.colliders[0].pose, run.engine.world().colliders[0].pose);
  EXPECT_EQ(read.colliders[0].twist, run.engine.world().colliders[0].twist);
  other.engine.replace(std::move(read), nullptr);
  run.until(0.12), other.until(0.12);
  EXPECT_EQ(state_hash(run.engine.world()), state_hash(other.engine.world()));
  std::filesystem::remove(file);
}

// A gate that stands again is as if it had always stood there, and lets nothing through while it
// moves.
TEST(MovingColliders, AGateThatOpensStaysOpen) {
  Simulation s(parse_scene(scene("{min: [0, 0, 0], max: [0.6, 0.3, 0.12], spacing: 0.02}",
                                 "{type: newtonian, preset: water, bulk_modulus: 1.0e5}",
                                 "{box: {min: [0, 0, 0], max: [0.2, 0.16, 0.12]}}",
                                 "{shape: {box: {min: [0.2, 0, 0], max: [0.28, 0.3, 0.12]}}}", "[0, -9.81, 0]"),
                           "gate.yaml"),
               quiet());
  const auto beyond = [&] {
    std::size_t n = 0;
    for (const Vec3f& p : s.particles("matter").position) n += p.x > 0.28f;
    return n;
  };
  s.advance_to(0.2);
  EXPECT_EQ(beyond(), 0u);
  s.set_motion("thing", {{0, 1, 0}, {}, {}});
  s.advance_to(0.3);
  s.set_motion("thing", {});
  s.advance_to(0.6);
  EXPECT_NEAR(s.collider("thing").pose.position.y, 0.1, 0.01);
  EXPECT_GT(beyond(), s.particle_count() / 4);
  for (const Vec3f& p : s.particles("matter").position)
    EXPECT_FALSE(p.x > 0.21f && p.x < 0.27f && p.y > 0.12f) << p.x << " " << p.y;
}

// With contact at nodes, for comparison, colliders stop and carry matter too, but only where nodes
// are inside of them: a plate whose face lies between nodes is felt up to a cell late.
TEST(MovingColliders, ContactAtNodesIsForComparison) {
  double heights[2];
  for (const bool surfaces : {true, false}) {
    std::string text = scene("{min: [0, 0, 0], max: [0.4, 0.3, 0.2], spacing: 0.02}",
                             "{type: newtonian, preset: water, bulk_modulus: 1.0e5}",
                             "{box: {min: [0, 0.14, 0], max: [0.4, 0.22, 0.2]}}",
                             "{shape: {box: {min: [0, 0, 0], max: [0.4, 0.14, 0.2]}}}", "[0, -9.81, 0]");
    if (!surfaces) text.replace(text.find("{fps: 100}"), 10, "{fps: 100, surface_contact: false}");
    Moved run(text);
    run.move({{0, 0.05, 0}, {}, {}});
    run.until(0.4);
    heights[surfaces] = run.center().y - 0.14 - 0.05 * 0.4;
  }
  std::printf("half the depth: %.4g m with contact at surfaces, %.4g m at nodes\n", heights[1], heights[0]);
  EXPECT_NEAR(heights[1], 0.04, 0.004);
  EXPECT_LT(heights[0], heights[1] - 0.002);
  EXPECT_GT(heights[0], 0);
}

// A bar of jelly is stretched by pins at its ends: the force is that of Hooke's law for the part
// between them.
TEST(MovingColliders, PinsStretchABar) {
  const double side = 0.06, strain = 0.05, modulus = 1e5;
  Moved run(
      "dreampm: 1\nname: bar\nspace: {min: [0, 0, 0], max: [0.5, 0.14, 0.14], spacing: 0.01}\ntime: {fps: 50, "
      "damping: 20}\ngravity: [0, 0, 0]\nmaterials: {jelly: {type: neo_hookean, density: 1000, youngs_modulus: 1.0e5, "
      "poissons_ratio: 0.3}}\nbodies: {bar: {material: jelly, shape: {box: {min: [0.08, 0.04, 0.04], max: [0.4, 0.1, "
      "0.1]}}, sample: {pattern: lattice}}}\npins:\n  right: {shape: {box: {min: [0.36, 0.02, 0.02], max: [0.44, 0.12, "
      "0.12]}}, motion: {keys: [{t: 0}, {t: 0.4, position: [0.012, 0, 0]}]}}\n  "
      "left: {shape: {box: {min: [0.04, 0.02, 0.02], max: [0.12, 0.12, 0.12]}}}\n");
  run.until(0.8);
  run.given = {};
  const double from = run.engine.world().time;
  run.until(1.0);
  const double force = run.given.impulse.x / (run.engine.world().time - from);
  const double expected = modulus * side * side * strain;
  std::printf("%.4g N of E A strain = %.4g N\n", force, expected);
  EXPECT_NEAR(force, expected, 0.05 * expected);
}

// A slab of jelly under a ceiling that holds it with a tension above its weight, or below.
TEST(MovingColliders, AStickyCeilingHoldsWhatIsNotTooHeavy) {
  double fell[2];
  for (const bool holds : {false, true}) {
    const std::string text = scene("{min: [0, 0, 0], max: [0.3, 0.4, 0.3], spacing: 0.015}",
                                   "{type: neo_hookean, density: 1000, youngs_modulus: 5.0e4, poissons_ratio: 0.3}",
                                   "{box: {min: [0.09, 0.22, 0.09], max: [0.21, 0.28, 0.21]}}",
                                   "{shape: {box: {min: [0, 0.28, 0], max: [0.3, 0.4, 0.3]}}, sticky: " +
                                       std::string(holds ? "1500" : "250") + "}",
                                   "[0, -9.81, 0]");  // its weight is 590 Pa
    Moved run(text);
    run.until(0.3);
    fell[holds] = 0.25 - run.center().y;
  }
  std::printf("fell %.4f m with less than its weight, %.4f m with more\n", fell[0], fell[1]);
  EXPECT_GT(fell[0], 0.1);
  EXPECT_LT(fell[1], 0.005);
}

// A floor that rises, as a sequence of meshes and as a box that moves: water is lifted alike. Bits
// do not depend on threads and restarts.
TEST(MovingColliders, ASequenceOfMeshesLiftsWater) {
  const auto folder = std::filesystem::temp_directory_path() / ("dreampm_floor_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  for (int file = 0; file < 4; ++file) {
    std::ofstream out(folder / ("floor.00" + std::string(file < 3 ? "0" : "") + std::to_string(7 + file) + ".obj"));
    for (int n = 0; n < 8; ++n)
      out << "v " << (n & 1 ? 0.5 : -0.1) << ' ' << (n & 2 ? 0.14 + 0.02 * file : -0.1) << ' ' << (n & 4 ? 0.3 : -0.1)
          << '\n';
    out << "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
  }
  const auto with = [&](const std::string& collider) {
    return scene("{min: [0, 0, 0], max: [0.4, 0.4, 0.2], spacing: 0.02}",
                 "{type: newtonian, preset: water, bulk_modulus: 1.0e5}",
                 "{box: {min: [0, 0.14, 0], max: [0.4, 0.22, 0.2]}}", collider, "[0, -9.81, 0]");
  };
  const std::string sequence = with("{shape: {meshes: " + folder.string() + "/floor.####.obj, fps: 10}}");
  double heights[2];
  for (const bool meshes : {false, true}) {
    Moved run(meshes ? sequence
                     : with("{shape: {box: {min: [-0.1, -0.1, -0.1], max: [0.5, 0.14, 0.3]}}, motion: {keys: [{t: 0}, "
                            "{t: 0.3, position: [0, 0.06, 0]}]}}"));
    run.until(0.3);
    heights[meshes] = run.center().y;
  }
  std::printf("at %.4f m on meshes, at %.4f m on a box\n", heights[1], heights[0]);
  EXPECT_NEAR(heights[0], 0.24, 0.004);
  EXPECT_NEAR(heights[1], heights[0], 0.001);
  expect_same_bits(parse_scene(sequence, "floor.yaml"), 0.05, 0.1);
  std::filesystem::remove_all(folder);
}

TEST(MovingColliders, BadMotionsAreRefused) {
  Simulation s(parse_scene(paddle_in_water("slip"), "paddle.yaml"), quiet());
  EXPECT_THAT(refusal([&] { s.set_motion("thin", {}); }), HasSubstr("collider thin is not in the scene; it has thing"));
  EXPECT_THAT(refusal([&] { s.collider("thin"); }), HasSubstr("it has thing"));
  EXPECT_THAT(refusal([&] { s.set_motion("thing", {{0, NAN, 0}, {}, {}}); }), HasSubstr("must be finite"));
  // A body where the collider has come to is refused as one where it stood at first.
  s.set_motion("thing", {{0, 0.5, 0}, {}, {}});
  s.advance_to(0.2);
  const auto above = [](double y) {
    return model::Body{"drop", "matter", Shape::box({0.16, y, 0.06}, {0.24, y + 0.04, 0.14})};
  };
  EXPECT_THAT(refusal([&] { s.add(above(0.29)); }), HasSubstr("collider thing"));
  s.add(above(0.19));
}

TEST(MovingColliders, AFixedStepMustBeShortEnough) {
  std::string text = paddle_in_water("slip");
  text.replace(text.find("{fps: 100}"), 10, "{fps: 100, dt: 2.0e-4}");
  Simulation s(parse_scene(text, "paddle.yaml"), quiet());
  s.advance_to(0.001);
  s.set_motion("thing", {{0, 500, 0}, {}, {}});
  EXPECT_THAT(refusal([&] { s.step(); }), HasSubstr("time.dt"));
  s.set_motion("thing", {{0, 0.5, 0}, {}, {}});
  s.step();
}

}  // namespace
}  // namespace dreampm
