#include <array>
#include <nlohmann/json.hpp>
#include <utility>

#include "bench/bench.h"
#include "bench/edits.h"
#include "bench/solvers.h"
#include "bench/surfaces.h"
#include "verbs.h"

namespace dreampm::cli {
namespace {
using Json = nlohmann::ordered_json;

/// Returns the facts that every measurement has to name.
Json with_machine(const Json& more) {
  Json all{{"machine", this_machine("", 0).cpu},
           {"cores", this_machine("", 0).cores},
           {"compiler", compiler},
           {"commit", commit}};
  all.update(more);
  return all;
}
std::string machine_text() {
  const MachineRecord machine = this_machine("", 0);
  return fmt::format("{}, {} cores, {}, commit {}", machine.cpu, machine.cores, compiler, commit);
}

void print_json(const StepBenchResult& r, const Ceilings& c) {
  const Floors floors = floors_of(r, c);
  const Json result{{"name", "step"},
                    {"material", r.material},
                    {"particles", r.particles},
                    {"droplets", r.droplets},
                    {"cells", {r.cells.x, r.cells.y, r.cells.z}},
                    {"threads", r.threads},
                    {"isa", r.isa},
                    {"ns_per_particle_step", r.ns_per_particle_step},
                    {"cpu_ns_per_particle_step", r.cpu_ns},
                    {"mps", r.mps},
                    {"spread", r.spread},
                    {"stages", r.stages},
                    {"steps_per_sort", r.steps_per_sort},
                    {"bytes_per_particle", r.bytes_per_particle},
                    {"memory_per_particle", r.memory_per_particle},
                    {"peak_memory_bytes", r.peak_memory_bytes},
                    {"operations", r.operations},
                    {"bytes_moved", r.bytes_moved},
                    {"floors", {{"fma_ns", floors.fma_ns}, {"bandwidth_ns", floors.bandwidth_ns}}},
                    {"windows", r.windows},
                    {"cpu_windows", r.cpu_windows}};
  const Json all = with_machine(
      {{"ceilings", {{"fma_gflops", c.fma_gflops}, {"triad_gb_s", c.triad_gb_s}}}, {"results", Json::array({result})}});
  fmt::print("{}\n", all.dump(2));
}

void print_text(const StepBenchResult& r, const Ceilings& c) {
  const Floors floors = floors_of(r, c);
  fmt::print("step, {}, {} particles{}, {} thread{}, {}: {:.1f} ns per particle-step, {:.2f} M particle-steps/s\n",
             r.material, grouped(r.particles), r.droplets ? " in droplets" : "", r.threads, r.threads == 1 ? "" : "s",
             r.isa, r.ns_per_particle_step, r.mps);
  for (const auto& [stage, share] : r.stages) fmt::print("  {:<10}{:5.1f} %\n", stage, 100 * share);
  fmt::print("  a sort every {:.1f} steps; windows:", r.steps_per_sort);
  for (const double w : r.windows) fmt::print(" {:.1f}", w);
  fmt::print(" ns, spread {:.1f} %\n", 100 * r.spread);
  fmt::print("  {:.0f} bytes a particle in columns and grids, {:.0f} all in, {} at most\n", r.bytes_per_particle,
             r.memory_per_particle, bytes_text(r.peak_memory_bytes));
  fmt::print("  the machine's ceilings: {:.0f} Gflop/s of multiply-adds, {:.1f} GB/s of memory\n", c.fma_gflops,
             c.triad_gb_s);
  fmt::print("  floors: {:.1f} ns for {:.0f} operations ({:.1f} x), {:.1f} ns for {:.0f} bytes ({:.1f} x)\n",
             floors.fma_ns, r.operations, r.ns_per_particle_step / floors.fma_ns, floors.bandwidth_ns, r.bytes_moved,
             r.ns_per_particle_step / floors.bandwidth_ns);
  fmt::print("  {}\n", machine_text());
}

Json json_of(const BenchRow& r) {
  Json row{{"case", r.what}, {"particles", r.particles}, {"isa", r.isa}, {"threads", r.threads}};
  row["value"] = r.value ? Json(*r.value) : Json();
  row.update(Json{{"unit", r.unit}, {"spread", r.spread}, {"note", r.value ? r.note : "not run here"}});
  return row;
}

/// A line of a markdown table.
std::string line_of(const BenchRow& r) {
  return fmt::format("| {} | {} | {} | {} | {} | {} | {} |", r.what, r.particles ? grouped(r.particles) : "", r.isa,
                     r.threads, r.value ? fmt::format("{:.3g} {}", *r.value, r.unit) : "not run here",
                     r.spread > 0 ? fmt::format("{:.1f} %", 100 * r.spread) : "", r.note);
}

void print_head(int shrink) {
  fmt::print("{}\n\n", machine_text());
  if (shrink > 1) fmt::print("Scenes are {} times shorter than they should be: no figure of speed.\n\n", shrink);
  fmt::print("| case | particles | ISA | threads | result | spread | |\n|---|---|---|---|---|---|---|\n");
}

void print_rows(const std::vector<BenchRow>& rows, int shrink, bool json) {
  if (!json) {
    print_head(1);
    for (const BenchRow& r : rows) fmt::print("{}\n", line_of(r));
    return;
  }
  Json all = Json::array();
  for (const BenchRow& r : rows) all.push_back(json_of(r));
  fmt::print("{}\n", with_machine({{"shrink", shrink}, {"results", all}}).dump(2));
}

int run_table(TableOptions options, bool json) {
  if (!json) {
    // The head comes with the first row: what cannot be measured has no table.
    options.each = [shrink = options.shrink, begun = false](const BenchRow& r) mutable {
      if (!std::exchange(begun, true)) print_head(shrink);
      fmt::print("{}\n", line_of(r));
      std::fflush(stdout);
    };
  }
  const std::vector<BenchRow> rows = bench_table(options);
  if (json) print_rows(rows, options.shrink, true);
  return 0;
}

void add_step(CLI::App& bench, Action& action) {
  struct Arguments {
    StepBenchOptions options;
    std::vector<int> cells;
    std::string solver = "explicit";
    std::array<bool, 4> taps{};  ///< by Tap
    bool json = false, each = false;
  };
  auto a = std::make_shared<Arguments>();
  CLI::App* verb = add_verb(bench, "step", "A moving, collapsing column, 8 particles a cell, every cost counted",
                            "dreampm bench step --material elastic --particles 100000 --threads 2 --json");
  verb->add_option("--material", a->options.material, "type of the material")->capture_default_str();
  auto* particles = verb->add_option("--particles", a->options.particles, "how many, rounded to a column of cells")
                        ->capture_default_str()
                        ->transform(whole_number(64, 200000000));
  verb->add_option("--cells", a->cells, "the column's cells along x, y and z, instead of --particles")
      ->expected(3)
      ->transform(whole_number(2, 1000))
      ->excludes(particles);
  verb->add_option("--solver", a->solver,
                   "explicit, or projection: large steps of water at rest and in a splash, with one thread and all")
      ->capture_default_str()
      ->check(CLI::IsMember({"explicit", "projection"}));
  verb->add_flag("--droplets", a->options.droplets, "drops of 8 particles, far apart and falling, instead of a column")
      ->excludes("--cells");
  const std::pair<const char*, const char*> taps[]{
      {"--emitter", "what bringing matter in costs beside the step: the step without it, with it, and its share"},
      {"--sink", "the same of taking matter out"},
      {"--moving", "the same of a mesh of 4,512 faces that turns, beside one that stands"},
      {"--edit", "the same of changing a value of the material before every step"}};
  for (std::size_t t = 0; t < a->taps.size(); ++t)
    verb->add_flag(taps[t].first, a->taps[t], taps[t].second)->excludes("--droplets");
  verb->add_option("--threads", a->options.threads, "threads")->capture_default_str()->transform(whole_number(1, 4096));
  verb->add_option("--isa", a->options.isa, "auto, sse4, avx2 or avx512")->capture_default_str();
  verb->add_option("--windows", a->options.windows, "measurements, of which the median counts")
      ->capture_default_str()
      ->transform(whole_number(1, 1000000));
  verb->add_option("--seconds", a->options.window_seconds, "the least length of each")
      ->capture_default_str()
      ->check(number_in(0, 1000));
  auto* json = verb->add_flag("--json", a->json, "print JSON");
  verb->add_flag("--each", a->each, "print every window as it ends: its ns by the clock, and of processor time")
      ->excludes(json);
  verb->callback([a, &action] {
    action = [a] {
      if (!a->cells.empty()) a->options.cells = Vec3i{a->cells[0], a->cells[1], a->cells[2]};
      if (a->each)
        a->options.each = [](double ns, double cpu_ns) {
          fmt::print("window {:.4f} {:.4f}\n", ns, cpu_ns);
          std::fflush(stdout);
        };
      std::vector<Tap> asked;
      for (const Tap tap : {Tap::emitter, Tap::sink, Tap::moving, Tap::edit})
        if (a->taps[static_cast<std::size_t>(tap)]) asked.push_back(tap);
      if (!asked.empty()) {
        a->options.large_steps = a->solver == "projection";
        print_rows(bench_taps(a->options, asked), 1, a->json);
        return 0;
      }
      if (a->solver == "projection") {
        print_rows(bench_projection(a->options), 1, a->json);
        return 0;
      }
      const StepBenchResult r = bench_step(a->options);
      const Ceilings ceilings = measure_ceilings(r.isa, r.threads);
      a->json ? print_json(r, ceilings) : print_text(r, ceilings);
      return 0;
    };
  });
}

void add_all(CLI::App& bench, Action& action) {
  auto options = std::make_shared<TableOptions>();
  auto json = std::make_shared<bool>(false);
  CLI::App* verb = add_verb(bench, "all", "What the machine can do, then every case, as a markdown table; minutes",
                            "dreampm bench all --isa avx2");
  verb->add_option("--isa", options->isa, "only this one: sse4, avx2 or avx512");
  verb->add_option("--windows", options->windows, "measurements of each row, of which the median counts")
      ->capture_default_str()
      ->transform(whole_number(1, 1000));
  verb->add_option("--seconds", options->window_seconds, "the least length of each")
      ->capture_default_str()
      ->check(number_in(0, 1000));
  verb->add_option("--shrink", options->shrink, "divide the lengths of every scene: only to see that it works")
      ->capture_default_str()
      ->transform(whole_number(1, 16));
  verb->add_flag("--json", *json, "print JSON");
  verb->callback([options, json, &action] { action = [options, json] { return run_table(*options, *json); }; });
}

void add_frames(CLI::App& bench, Action& action) {
  struct Arguments {
    SceneArguments scene;
    int frames = 1000000;
    bool json = false;
  };
  auto a = std::make_shared<Arguments>();
  CLI::App* verb = add_verb(
      bench, "frames", "What a scene's frames of water cost by the projection beside explicit steps, on one thread",
      "dreampm bench frames scenes/dam-break.yaml --variant preview --frames 25");
  a->scene.add_to(*verb);
  verb->add_option("--frames", a->frames, "up to this frame of the scene")->transform(whole_number(2, 1000000));
  verb->add_flag("--json", a->json, "print JSON");
  verb->callback([a, &action] {
    action = [a] {
      const model::Scene scene = a->scene.load();
      const SolversCost c = bench_solvers(scene, a->frames);
      const double ratio = c.explicit_steps.cpu_seconds / c.projection.cpu_seconds;
      if (a->json) {
        const auto of = [](const SolverCost& s) {
          return Json{{"steps", s.steps}, {"particle_steps", s.particle_steps}, {"cpu_seconds", s.cpu_seconds}};
        };
        fmt::print("{}\n", with_machine({{"name", "frames"},
                                         {"scene", scene.name},
                                         {"particles", c.particles},
                                         {"explicit", of(c.explicit_steps)},
                                         {"projection", of(c.projection)},
                                         {"ratio", ratio}})
                               .dump(2));
        return 0;
      }
      const auto text = [](const char* name, const SolverCost& s) {
        return fmt::format("{}: {:.2f} s of processor time, {} steps, {:.1f} ns per particle-step\n", name,
                           s.cpu_seconds, grouped(s.steps),
                           1e9 * s.cpu_seconds / static_cast<double>(s.particle_steps));
      };
      fmt::print("{}, {} particles: by the projection 1/{:.1f} of explicit steps\n  {}  {}  {}\n", scene.name,
                 grouped(c.particles), ratio, text("explicit", c.explicit_steps), text("projection", c.projection),
                 machine_text());
      return 0;
    };
  });
}

void add_edits(CLI::App& bench, Action& action) {
  struct Arguments {
    EditBenchOptions options;
    bool json = false;
  };
  auto a = std::make_shared<Arguments>();
  CLI::App* verb =
      add_verb(bench, "edits", "What edits of a running simulation cost: gravity, a parameter, a wall, a crate",
               "dreampm bench edits --particles 100000");
  verb->add_option("--particles", a->options.particles, "about how many")
      ->capture_default_str()
      ->transform(whole_number(1000, 100000000));
  verb->add_option("--faces", a->options.faces, "about how many, of the mesh beside them")
      ->capture_default_str()
      ->transform(whole_number(100, 10000000));
  verb->add_option("--threads", a->options.threads, "threads")->capture_default_str()->transform(whole_number(1, 4096));
  verb->add_option("--rounds", a->options.rounds, "edits of each kind, of which the median counts")
      ->capture_default_str()
      ->transform(whole_number(1, 100000));
  verb->add_flag("--json", a->json, "print JSON");
  verb->callback([a, &action] {
    action = [a] {
      print_rows(bench_edits(a->options), 1, a->json);
      return 0;
    };
  });
}

void add_surfaces(CLI::App& bench, Action& action) {
  struct Arguments {
    SurfaceBenchOptions options;
    std::string write;
    bool json = false;
  };
  auto a = std::make_shared<Arguments>();
  CLI::App* verb = add_verb(bench, "surface", "What wrapping particles in a mesh costs, stage by stage",
                            "dreampm bench surface --particles 1048576 --threads 2");
  verb->add_option("--particles", a->options.particles, "about how many")
      ->capture_default_str()
      ->transform(whole_number(1000, 100000000));
  verb->add_option("--voxel", a->options.voxel, "the edge of a voxel, in spacings")
      ->capture_default_str()
      ->check(number_in(0.125, 2));
  verb->add_option("--threads", a->options.threads, "threads")->capture_default_str()->transform(whole_number(1, 4096));
  verb->add_option("--rounds", a->options.rounds, "meshes, of which the median counts")
      ->capture_default_str()
      ->transform(whole_number(1, 1000));
  verb->add_flag("--colliders", a->options.solids, "a pillar and a ball stand in the water");
  verb->add_option("--write", a->write, "write the particles to this PLY file, for other programs");
  verb->add_flag("--json", a->json, "print JSON");
  verb->callback([a, &action] {
    action = [a] {
      a->options.write = a->write;
      print_rows(bench_surface(a->options), 1, a->json);
      return 0;
    };
  });
}

}  // namespace

void add_bench(CLI::App& app, Action& action) {
  CLI::App* bench = add_verb(app, "bench", "Measure how fast the step is on this machine",
                             "dreampm bench step --material newtonian --particles 1000000 --threads 1");
  bench->require_subcommand(1);
  add_step(*bench, action);
  add_all(*bench, action);
  add_frames(*bench, action);
  add_edits(*bench, action);
  add_surfaces(*bench, action);
#ifdef DM_APP
  add_bench_play(*bench, action);
#endif
}

}  // namespace dreampm::cli
