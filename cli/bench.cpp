#include <array>
#include <nlohmann/json.hpp>
#include <utility>

#include "bench/bench.h"
#include "bench/edits.h"
#include "bench/solvers.h"
#include "bench/surfaces.h"
#include "bench_print.h"
#include "verbs.h"

namespace dreampm::cli {
namespace {
using Json = nlohmann::ordered_json;

/// --backend of what is measured, and --isa of cpu; `rest` of the text about it.
void add_backend(CLI::App& verb, BenchBackend& choice, const std::string& rest = {}) {
  verb.add_option("--backend", choice.backend,
                  "which is measured: " + fmt::format("{}", fmt::join(backend_names(), ", ")) + rest)
      ->check(CLI::IsMember(backend_names()))
      ->capture_default_str();
}

void add_step(CLI::App& bench, Action& action) {
  struct Arguments {
    StepBenchOptions options;
    std::vector<int> cells;
    std::string solver = "explicit";
    std::array<bool, 4> taps{};  ///< by Tap
    std::optional<int> threads;
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
  add_backend(*verb, a->options.backend);
  verb->add_option("--threads", a->threads, "threads (default: 1, beside a device all)")
      ->transform(whole_number(1, 4096));
  verb->add_option("--isa", a->options.backend.isa, "of cpu: auto, sse4, avx2 or avx512")->capture_default_str();
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
      a->options.threads = a->threads.value_or(a->options.backend.on_host() ? 1 : thread_count());
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
        print_rows(bench_taps(a->options, asked), 1, a->json, device_text(a->options.backend));
        return 0;
      }
      if (a->solver == "projection") {
        print_rows(bench_projection(a->options), 1, a->json);
        return 0;
      }
      const StepBenchResult r = bench_step(a->options);
      std::optional<Ceilings> ceilings;
      if (r.device.empty()) ceilings = measure_ceilings(r.isa, r.threads);
      print_step(r, ceilings, a->json);
      return 0;
    };
  });
}

void add_all(CLI::App& bench, Action& action) {
  struct Arguments {
    TableOptions options;
    BenchBackend backend;
    std::uint64_t largest = DeviceTableOptions{}.largest;
    bool json = false;
  };
  auto a = std::make_shared<Arguments>();
  CLI::App* verb = add_verb(bench, "all", "What the machine can do, then every case, as a markdown table; minutes",
                            "dreampm bench all --isa avx2");
  add_backend(*verb, a->backend, "; of one with a device, steps of up to 64 million particles");
  auto* isa = verb->add_option("--isa", a->options.isa, "of cpu only this one: sse4, avx2 or avx512");
  auto* largest = verb->add_option("--largest", a->largest, "of a device: no row of more particles")
                      ->capture_default_str()
                      ->transform(whole_number(64, 200000000));
  verb->add_option("--windows", a->options.windows, "measurements of each row, of which the median counts")
      ->capture_default_str()
      ->transform(whole_number(1, 1000));
  verb->add_option("--seconds", a->options.window_seconds, "the least length of each")
      ->capture_default_str()
      ->check(number_in(0, 1000));
  auto* shrink = verb->add_option("--shrink", a->options.shrink,
                                  "of cpu: divide the lengths of every scene: only to see that it works")
                     ->capture_default_str()
                     ->transform(whole_number(1, 16));
  verb->add_flag("--json", a->json, "print JSON");
  verb->callback([=, &action] {
    action = [=] {
      const bool cpu = a->backend.backend == BenchBackend{}.backend;
      for (const CLI::Option* option : cpu ? std::vector{largest} : std::vector{isa, shrink})
        if (option->count() > 0)
          fail_input("{}: not with --backend {}; leave it out", option->get_name(), a->backend.backend);
      const MeasureTable table = [&](const EachRow& each) {
        TableOptions options = a->options;
        options.each = each;
        return bench_table(options);
      };
      const MeasureTable of_device = [&](const EachRow& each) {
        return bench_device_table(
            {a->backend.backend, a->largest, a->options.windows, a->options.window_seconds, each});
      };
      print_table(a->options.shrink, device_text(a->backend), a->json, cpu ? table : of_device);
      return 0;
    };
  });
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
  add_backend(*verb, a->options.backend);
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
      print_rows(bench_edits(a->options), 1, a->json, device_text(a->options.backend));
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
