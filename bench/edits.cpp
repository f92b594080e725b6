#include "bench/edits.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include "bench/bench_mesh.h"
#include "bench/course.h"
#include "bench/temporary_folder.h"
#include "dreampm/io/ply.h"
#include "dreampm/simulation.h"

namespace dreampm {
namespace {

/// m: the sides of the box, of which water fills the lower half.
constexpr Vec3d box{0.4, 0.4, 0.4};
constexpr double crate_side = 0.05;

model::Collider crate(std::string name, const Vec3d& at) {
  model::Collider body{std::move(name),
                       Shape::box(at - Vec3d{1, 1, 1} * (0.5 * crate_side), at + Vec3d{1, 1, 1} * (0.5 * crate_side))};
  body.friction = 0.4;
  body.rigid = {.density = 400};
  return body;
}

/// Water about a mesh of that file.
Scene pool(const EditBenchOptions& options, const std::string& mesh) {
  model::Scene scene;
  scene.name = "pool";
  const double volume = box.x * box.z * 0.5 * box.y;
  scene.space.max = box;
  scene.space.spacing = std::cbrt(volume / static_cast<double>(options.particles));
  scene.materials = {{"water", "newtonian", preset("newtonian", "water")}};
  scene.bodies = {{"pool", "water", Shape::box({0, 0, 0}, {box.x, 0.5 * box.y, box.z})}};
  scene.bodies[0].cut = {"stone"};
  scene.colliders = {{"stone", Shape::mesh(mesh)}};
  return Scene(std::move(scene));
}

double milliseconds(const std::function<void()>& edit) {
  const auto begun = std::chrono::steady_clock::now();
  edit();
  return 1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
}

/// Lines of the simulation are of no use here.
class Silent final : public Host {
  void info(const std::string&) override {}
  void warning(const std::string&) override {}
};

}  // namespace

std::vector<BenchRow> bench_edits(const EditBenchOptions& options) {
  check_isa(options.backend);
  const TemporaryFolder folder;
  const std::string mesh = (folder.path / "stone.ply").string();
  const TriMesh stone = lobed_ball({0.2, 0.1, 0.2}, 0.08, options.faces);
  write_mesh(mesh, stone);
  Silent host;
  Simulation simulation(
      pool(options, mesh),
      {.backend = options.backend.backend, .isa = options.backend.isa, .threads = options.threads, .host = &host});
  std::vector<BenchRow> rows;
  std::vector<double> forming;
  const auto row = [&](const char* what, const std::vector<double>& times, const std::string& note) {
    rows.push_back({what, simulation.particle_count(), simulation.isa(), options.threads, median_of(times), "ms",
                    spread_of(times), note, options.backend.backend});
  };
  // The formation of the grid is not part of the edit: it is measured apart, and steps lie between.
  const auto measure = [&](const char* what, const std::function<void(int)>& edit,
                           const std::function<void()>& after = {}, const std::string& note = {}) {
    std::vector<double> times;
    for (int round = 0; round < options.rounds; ++round) {
      times.push_back(milliseconds([&] { edit(round); }));
      forming.push_back(milliseconds([&] { simulation.dt(); }));
      simulation.step();
      if (after) after();
    }
    row(what, times, note);
  };
  simulation.advance_steps(5);
  measure("a parameter", [&](int n) { simulation.set_parameter("water", "viscosity", n % 2 ? 0.002 : 0.001); });
  measure("a wall", [&](int n) { simulation.set_wall(Side::x_max, {n % 2 ? WallType::slip : WallType::separate}); });
  const std::vector<double> first{milliseconds([&] { simulation.add(crate("first", {0.1, 0.3, 0.1})); })};
  simulation.step();
  const std::string faces = fmt::format("beside a mesh of {} faces", stone.triangles.size());
  std::vector<double> out;
  measure(
      "a crate more", [&](int) { simulation.add(crate("crate", {0.3, 0.3, 0.3})); },
      [&] { out.push_back(milliseconds([&] { simulation.remove_collider("crate"); })); }, faces);
  row("taking it out", out, faces);
  row("the first crate", first, faces);
  row("forming the grid anew", forming, "once for all edits before a step");
  forming.clear();
  measure("gravity", [&](int n) { simulation.set_gravity({n % 2 ? 1.0 : 0.0, -9.81, 0}); }, {}, "forms no grid anew");
  return rows;
}

}  // namespace dreampm
