#include "bench_print.h"

#include <utility>

#include "verbs.h"

namespace dreampm::cli {
using Json = nlohmann::ordered_json;

Json with_machine(const Json& more) {
  Json all{{"machine", this_machine("", 0).cpu},
           {"cores", this_machine("", 0).cores},
           {"compiler", compiler},
           {"commit", commit}};
  all.update(more);
  return all;
}

std::string device_text(const BenchBackend& choice) {
  const std::optional<DeviceFacts> device = device_of(choice);
  return device ? device->about : std::string();
}

std::string machine_text() {
  const MachineRecord machine = this_machine("", 0);
  return fmt::format("{}, {} cores, {}, commit {}", machine.cpu, machine.cores, compiler, commit);
}

namespace {

void print_json(const StepBenchResult& r, const std::optional<Ceilings>& c) {
  Json result{{"name", "step"},
              {"material", r.material},
              {"particles", r.particles},
              {"droplets", r.droplets},
              {"cells", {r.cells.x, r.cells.y, r.cells.z}},
              {"threads", r.threads},
              {"backend", r.backend},
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
              {"windows", r.windows},
              {"cpu_windows", r.cpu_windows}};
  Json more = Json::object();
  if (c) {
    const Floors floors = floors_of(r, *c);
    result["floors"] = {{"fma_ns", floors.fma_ns}, {"bandwidth_ns", floors.bandwidth_ns}};
    more["ceilings"] = {{"fma_gflops", c->fma_gflops}, {"triad_gb_s", c->triad_gb_s}};
  } else {
    result["device_memory_per_particle"] = r.device_memory_per_particle;
    more["device"] = r.device;
  }
  more["results"] = Json::array({result});
  fmt::print("{}\n", with_machine(more).dump(2));
}

void print_text(const StepBenchResult& r, const std::optional<Ceilings>& c) {
  fmt::print("step, {}, {} particles{}, {} thread{}, {} {}: {:.{}f} ns per particle-step, {:.2f} M particle-steps/s\n",
             r.material, grouped(r.particles), r.droplets ? " in droplets" : "", r.threads, r.threads == 1 ? "" : "s",
             r.backend, r.isa, r.ns_per_particle_step, c ? 1 : 3, r.mps);
  for (const auto& [stage, share] : r.stages) fmt::print("  {:<10}{:5.1f} %\n", stage, 100 * share);
  fmt::print("  a sort every {:.1f} steps; windows:", r.steps_per_sort);
  for (const double w : r.windows) fmt::print(" {:.{}f}", w, c ? 1 : 3);
  fmt::print(" ns, spread {:.1f} %\n", 100 * r.spread);
  fmt::print("  {:.0f} bytes a particle in columns and grids, {:.0f} all in, {} at most\n", r.bytes_per_particle,
             r.memory_per_particle, bytes_text(r.peak_memory_bytes));
  if (c) {
    const Floors floors = floors_of(r, *c);
    fmt::print("  the machine's ceilings: {:.0f} Gflop/s of multiply-adds, {:.1f} GB/s of memory\n", c->fma_gflops,
               c->triad_gb_s);
    fmt::print("  floors: {:.1f} ns for {:.0f} operations ({:.1f} x), {:.1f} ns for {:.0f} bytes ({:.1f} x)\n",
               floors.fma_ns, r.operations, r.ns_per_particle_step / floors.fma_ns, floors.bandwidth_ns, r.bytes_moved,
               r.ns_per_particle_step / floors.bandwidth_ns);
  } else {
    if (r.device_memory_per_particle > 0)
      fmt::print("  {:.0f} bytes a particle of the device's memory\n", r.device_memory_per_particle);
    fmt::print("  at least {:.3g} GB/s: {:.0f} bytes to read and write once\n", r.bytes_moved / r.ns_per_particle_step,
               r.bytes_moved);
    fmt::print("  {}\n", r.device);
  }
  fmt::print("  {}\n", machine_text());
}

std::string note_of(const BenchRow& r) { return r.value || !r.note.empty() ? r.note : "not run here"; }

Json json_of(const BenchRow& r) {
  Json row{
      {"case", r.what}, {"particles", r.particles}, {"backend", r.backend}, {"isa", r.isa}, {"threads", r.threads}};
  row["value"] = r.value ? Json(*r.value) : Json();
  row.update(Json{{"unit", r.unit}, {"spread", r.spread}, {"note", note_of(r)}});
  return row;
}

/// A line of a markdown table.
std::string line_of(const BenchRow& r) {
  return fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} |", r.what, r.particles ? grouped(r.particles) : "",
                     r.backend, r.isa, r.threads, r.value ? fmt::format("{:.3g} {}", *r.value, r.unit) : "not run here",
                     r.spread > 0 ? fmt::format("{:.1f} %", 100 * r.spread) : "", r.note);
}

/// `device`: a line about it, or empty.
void print_head(int shrink, const std::string& device) {
  fmt::print("{}{}{}\n\n", device, device.empty() ? "" : "; ", machine_text());
  if (shrink > 1) fmt::print("Scenes are {} times shorter than they should be: no figure of speed.\n\n", shrink);
  fmt::print("| case | particles | backend | ISA | threads | result | spread | |\n|---|---|---|---|---|---|---|---|\n");
}

}  // namespace

void print_step(const StepBenchResult& result, const std::optional<Ceilings>& ceilings, bool json) {
  json ? print_json(result, ceilings) : print_text(result, ceilings);
}

void print_rows(const std::vector<BenchRow>& rows, int shrink, bool json, const std::string& device) {
  if (!json) {
    print_head(1, device);
    for (const BenchRow& r : rows) fmt::print("{}\n", line_of(r));
    return;
  }
  Json all = Json::array();
  for (const BenchRow& r : rows) all.push_back(json_of(r));
  Json more{{"shrink", shrink}};
  if (!device.empty()) more["device"] = device;
  more["results"] = all;
  fmt::print("{}\n", with_machine(more).dump(2));
}

void print_table(int shrink, const std::string& device, bool json, const MeasureTable& measure) {
  EachRow each;
  if (!json) {
    // The head comes with the first row: what cannot be measured has no table.
    each = [&, begun = false](const BenchRow& r) mutable {
      if (!std::exchange(begun, true)) print_head(shrink, device);
      fmt::print("{}\n", line_of(r));
      std::fflush(stdout);
    };
  }
  const std::vector<BenchRow> rows = measure(each);
  if (json) print_rows(rows, shrink, true, device);
}

}  // namespace dreampm::cli
