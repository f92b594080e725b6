#include <nlohmann/json.hpp>

#include "dreampm/pipeline/bench.h"
#include "verbs.h"

namespace dreampm::cli {
namespace {
using Json = nlohmann::ordered_json;

void print_json(const StepBenchResult& r, const Ceilings& c) {
  const MachineRecord machine = this_machine(r.isa, r.threads);
  const Json result{{"name", "step"},
                    {"material", r.material},
                    {"particles", r.particles},
                    {"threads", r.threads},
                    {"isa", r.isa},
                    {"ns_per_particle_step", r.ns_per_particle_step},
                    {"mps", r.mps},
                    {"stages", r.stages},
                    {"bytes_per_particle", r.bytes_per_particle},
                    {"peak_memory_bytes", r.peak_memory_bytes},
                    {"windows", r.windows}};
  const Json all{{"machine", machine.cpu},
                 {"compiler", compiler},
                 {"commit", commit},
                 {"ceilings", {{"fma_gflops", c.fma_gflops}, {"triad_gb_s", c.triad_gb_s}}},
                 {"results", Json::array({result})}};
  fmt::print("{}\n", all.dump(2));
}

void print_text(const StepBenchResult& r, const Ceilings& c) {
  fmt::print("step, {}, {} particles, {} thread{}, {}: {:.1f} ns per particle-step, {:.2f} M particle-steps/s\n",
             r.material, grouped(r.particles), r.threads, r.threads == 1 ? "" : "s", r.isa, r.ns_per_particle_step,
             r.mps);
  for (const auto& [stage, share] : r.stages) fmt::print("  {:<10}{:5.1f} %\n", stage, 100 * share);
  fmt::print("  {:.0f} bytes a particle, {} at most; windows:", r.bytes_per_particle, bytes_text(r.peak_memory_bytes));
  for (const double w : r.windows) fmt::print(" {:.1f}", w);
  fmt::print(" ns\n  the machine's ceilings: {:.0f} Gflop/s of multiply-adds, {:.1f} GB/s of memory\n", c.fma_gflops,
             c.triad_gb_s);
  fmt::print("  {}, {}, commit {}\n", this_machine(r.isa, r.threads).cpu, compiler, commit);
}

}  // namespace

void add_bench(CLI::App& app, Action& action) {
  auto options = std::make_shared<StepBenchOptions>();
  auto json = std::make_shared<bool>(false);
  CLI::App* bench = add_verb(app, "bench", "Measure how fast the step is on this machine",
                             "dreampm bench step --material newtonian --particles 1000000 --threads 1");
  bench->require_subcommand(1);
  CLI::App* verb = add_verb(*bench, "step", "A collapsing column, 8 particles a cell, every cost counted",
                            "dreampm bench step --material elastic --particles 100000 --threads 2 --json");
  verb->add_option("--material", options->material, "type of the material")->capture_default_str();
  verb->add_option("--particles", options->particles, "how many, rounded to a cube of cells")
      ->capture_default_str()
      ->check(CLI::Range(64, 200000000));
  verb->add_option("--threads", options->threads, "threads")->capture_default_str()->check(CLI::Range(1, 4096));
  verb->add_option("--isa", options->isa, "auto, sse4, avx2 or avx512")->capture_default_str();
  verb->add_flag("--json", *json, "print JSON");
  verb->callback([options, json, &action] {
    action = [options, json] {
      const StepBenchResult r = bench_step(*options);
      const Ceilings ceilings = measure_ceilings(r.isa, r.threads);
      *json ? print_json(r, ceilings) : print_text(r, ceilings);
      return 0;
    };
  });
}

}  // namespace dreampm::cli
