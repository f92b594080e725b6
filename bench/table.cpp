// The whole table: what the project watches, one line a case.
#include <algorithm>
#include <cmath>
#include <optional>

#include "bench/bench.h"
#include "bench/course.h"
#include "bench/frame_cost.h"
#include "bench/operations.h"
#include "dreampm/backend/cpu/cpu.h"
#include "dreampm/base/error.h"
#include "dreampm/base/parallel.h"
#include "dreampm/physics/materials.h"

namespace dreampm {
namespace {

constexpr Vec3i million{64, 64, 32}, hundred_thousand{32, 24, 16}, four_million{128, 64, 64};
constexpr Vec3i cells_65536{32, 16, 16}, cells_8192{16, 8, 8};

/// Every set that there are kernels for on this kind of machine, whether it has it or not.
std::vector<std::string_view> known_sets() {
#if defined(__x86_64__)
  return {"sse4", "avx2", "avx512"};
#else
  return cpu_instruction_sets();
#endif
}

/// Steps of a column.
struct StepCase {
  std::string_view material;
  Vec3i cells;
  bool every_isa;
  std::vector<int> threads;
};
const StepCase step_cases[] = {
    {"newtonian", million, true, {1, 2}},
    {"snow", million, true, {1, 2}},
    {"elastic", million, true, {1, 2}},
    {"sand", million, true, {1, 2}},
    {"seed", million, true, {1, 2}},
    {"newtonian", hundred_thousand, false, {1, 2}},
    {"newtonian", four_million, false, {1, 2}},
    {"newtonian", cells_65536, false, {2}},
    {"seed", cells_65536, false, {2}},
    {"newtonian", cells_8192, false, {2}},
    {"seed", cells_8192, false, {2}},
};

/// Makes rows and hands them on.
class Table {
 public:
  explicit Table(const TableOptions& options) : options_(options) {
    const auto here = cpu_instruction_sets();
    widest_ = options.isa.empty() ? std::string(here.back()) : std::string(make_cpu_backend(options.isa)->isa());
  }

  void limits();
  void steps(const StepCase& c);
  void droplets();
  void domain();
  void memory();
  void frames();
  void projection();
  std::vector<BenchRow> rows;

 private:
  void add(BenchRow row) {
    if (options_.each) options_.each(row);
    rows.push_back(std::move(row));
  }
  Vec3i shrunk(const Vec3i& cells) const {
    const auto of = [&](int n) { return std::max(2, n / options_.shrink); };
    return {of(cells.x), of(cells.y), of(cells.z)};
  }
  static BenchBackend by(const std::string& isa) { return {"cpu", isa}; }
  bool asked(std::string_view isa) const { return options_.isa.empty() || isa == widest_; }
  Pace pace() const { return {options_.windows, options_.window_seconds, {}}; }
  Timing timed(BenchScene scene) const {
    Pace few = pace();
    few.windows = std::min(few.windows, 3);  // half a million scattered particles take their time
    return Course(std::move(scene), by(widest_)).run(by(widest_), few);
  }
  const Ceilings& ceilings(const std::string& isa, int threads) {
    const auto [at, fresh] = ceilings_.try_emplace({isa, threads});
    if (fresh) at->second = measure_ceilings(isa, threads);
    return at->second;
  }
  /// Nanoseconds per particle-step of the million, one thread, widest set: measured before the rows
  /// that ask for it.
  const Timing& bulk() {
    if (!bulk_) {
      const ThreadLimit limit(1);
      bulk_ = timed(column_scene(*find_material("newtonian"), shrunk(million)));
    }
    return *bulk_;
  }

  const TableOptions& options_;
  std::string widest_;
  std::map<std::pair<std::string, int>, Ceilings> ceilings_;
  std::optional<Timing> bulk_;
};

void Table::limits() {
  for (const std::string_view isa : cpu_instruction_sets()) {
    if (!asked(isa)) continue;
    for (const int threads : {1, 2}) {
      const Ceilings& c = ceilings(std::string(isa), threads);
      add({"ceiling: multiply-adds", 0, std::string(isa), threads, c.fma_gflops, "Gflop/s", 0, {}});
      add({"ceiling: triad", 0, std::string(isa), threads, c.triad_gb_s, "GB/s", 0, {}});
    }
  }
}

void Table::steps(const StepCase& c) {
  const auto here = cpu_instruction_sets();
  const Course course(column_scene(*find_material(c.material), shrunk(c.cells)), by(widest_));
  const OperationCount operations = operations_of(course.world());
  StepBenchResult work;
  work.bytes_moved = bytes_moved_of(course.world());
  for (const std::string_view isa : known_sets()) {
    work.isa = isa;
    work.operations = static_cast<double>(operations.slots(fuses(isa)));
    if (c.every_isa ? !asked(isa) : isa != widest_) continue;
    for (const int threads : c.threads) {
      BenchRow row{std::string(c.material), course.world().particles(), std::string(isa), threads, {}, "M/s", 0, {}};
      if (std::find(here.begin(), here.end(), isa) != here.end()) {
        const ThreadLimit limit(threads);
        const Timing timing = course.run(by(row.isa), pace());
        const Floors floors = floors_of(work, ceilings(row.isa, threads));
        const double ns = median_of(timing.fair(threads));
        row.value = 1e3 / ns;
        row.spread = spread_of(timing.fair(threads));
        row.note = fmt::format("{:.1f} ns, {:.1f} x the FMA floor, {:.1f} x that of memory", ns, ns / floors.fma_ns,
                               ns / floors.bandwidth_ns);
        if (c.material == "newtonian" && row.isa == widest_ && threads == 1 && c.cells == million) bulk_ = timing;
      }
      add(std::move(row));
    }
  }
}

void Table::droplets() {
  constexpr std::uint64_t count = 100000;
  const ThreadLimit limit(1);
  const auto scaled = [&](std::uint64_t n) {
    return std::max<std::uint64_t>(8, n / static_cast<std::uint64_t>(std::pow(options_.shrink, 3)));
  };
  const MaterialInfo& water = *find_material("newtonian");
  const double half = timed(droplets_scene(water, scaled(count / 2))).cpu_median();
  const Timing all = timed(droplets_scene(water, scaled(count)));
  const double ns = all.cpu_median(), spread = spread_of(all.cpu_windows);
  add({"droplets of 8 over bulk", 8 * scaled(count), widest_, 1, ns / bulk().cpu_median(), "x", spread,
       fmt::format("a particle's cost, at most 5; {:.1f} ns", ns)});
  add({"droplets: all over half of them", 8 * scaled(count), widest_, 1, ns / half, "x", spread,
       "a particle's cost; 1: linear in their number"});
}

void Table::domain() {
  const ThreadLimit limit(1);
  const MaterialInfo& water = *find_material("newtonian");
  const int width = std::max(4, 32 / options_.shrink);
  const double tight = timed(drop_scene(water, width, {width + 4, width + 16, width + 4})).cpu_median();
  const Timing wide = timed(drop_scene(water, width, {10 * width, 10 * width, 10 * width}));
  add({"falling drop: domain of 1000 x its volume over a tight one",
       static_cast<std::uint64_t>(8 * width * width * width), widest_, 1, wide.cpu_median() / tight, "x",
       spread_of(wide.cpu_windows), "the same work: 1"});
}

void Table::memory() {
  const Course course(column_scene(*find_material("newtonian"), shrunk(million)), by(widest_));
  add({"memory of a liquid particle, all in", course.world().particles(), widest_, thread_count(),
       course.memory_per_particle() > 0 ? std::optional(course.memory_per_particle()) : std::nullopt, "B", 0,
       fmt::format("at most 64; columns and grids alone {:.0f}", bytes_per_particle(course.world()))});
}

void Table::frames() {
  const ThreadLimit limit(2);
  const Course course(column_scene(*find_material("newtonian"), shrunk(million)), by(widest_));
  BenchRow row = frame_row(course, by(widest_), widest_);
  row.note = "at most 5; " + row.note;
  add(std::move(row));
}

void Table::projection() {
  StepBenchOptions options;
  options.cells = shrunk(million), options.threads = 2, options.backend = by(widest_);
  options.windows = options_.windows, options.window_seconds = options_.window_seconds;
  for (BenchRow& row : bench_projection(options)) add(std::move(row));
}

/// The measurements beside the steps of a column.
constexpr void (Table::* other_cases[])() = {&Table::droplets, &Table::domain, &Table::memory, &Table::frames,
                                             &Table::projection};

}  // namespace

std::vector<BenchRow> bench_table(const TableOptions& options) {
  if (options.shrink < 1 || options.shrink > 16) fail_input("--shrink {}: give 1 to 16", options.shrink);
  Table table(options);
  table.limits();
  for (const StepCase& c : step_cases) table.steps(c);
  for (const auto measure : other_cases) (table.*measure)();
  return std::move(table.rows);
}

}  // namespace dreampm
