// The steps of a device: one line a case.
#include <map>
#include <optional>
#include <utility>

#include "bench/bench.h"
#include "bench/course.h"
#include "bench/frame_cost.h"
#include "bench/operations.h"
#include "dreampm/base/error.h"
#include "dreampm/base/parallel.h"
#include "dreampm/physics/materials.h"

namespace dreampm {
namespace {

/// Columns, the smallest of a material first: what they need gives what the next one will.
struct DeviceCase {
  std::string_view material;
  Vec3i cells;
  constexpr std::uint64_t particles() const { return 8 * static_cast<std::uint64_t>(cells.x) * cells.y * cells.z; }
};
constexpr Vec3i cells_8192{16, 8, 8}, cells_65536{32, 16, 16}, million{64, 64, 32}, eight_million{128, 128, 64},
    sixty_four_million{250, 250, 128};
constexpr DeviceCase device_cases[] = {
    {"newtonian", cells_8192},
    {"newtonian", cells_65536},
    {"newtonian", million},
    {"newtonian", eight_million},
    {"newtonian", sixty_four_million},
    {"snow", cells_8192},
    {"snow", cells_65536},
    {"snow", million},
    {"snow", eight_million},
    {"snow", sixty_four_million},
    {"elastic", million},
    {"elastic", eight_million},
    {"sand", million},
    {"sand", eight_million},
};

double gigabytes(double bytes) { return 1e-9 * bytes; }

/// Measures the steps of one case.
void measure(const DeviceCase& c, const DeviceTableOptions& options, const BenchBackend& choice, BenchRow& row,
             double& per_particle) {
  const Course course(column_scene(*find_material(c.material), c.cells), choice);
  if (course.device_memory_per_particle() > 0) per_particle = course.device_memory_per_particle();
  const Timing timing = course.run(choice, {options.windows, options.window_seconds, {}});
  const double ns = timing.median();
  row.value = 1e3 / ns, row.spread = spread_of(timing.windows);
  for (const auto& [stage, share] : timing.stages)
    row.note += fmt::format("{}{} {:.0f} %", row.note.empty() ? "" : ", ", stage, 100 * share);
  row.note += fmt::format("; at least {:.3g} GB/s", bytes_moved_of(course.world()) / ns);
  if (course.device_memory_per_particle() > 0)
    row.note += fmt::format("; {:.0f} B a particle on the device", course.device_memory_per_particle());
}

}  // namespace

std::vector<BenchRow> bench_device_table(const DeviceTableOptions& options) {
  const BenchBackend choice{options.backend, "auto"};
  if (choice.on_host())
    fail_input("--backend {}: it has no device; its table is that without --backend", choice.backend);
  const std::string isa(make_bench_backend(choice)->isa());
  std::vector<BenchRow> rows;
  std::map<std::string_view, double> per_particle;  // B, of the last case of the material
  for (const DeviceCase& c : device_cases) {
    if (c.particles() > options.largest) continue;
    BenchRow row{std::string(c.material), c.particles(), isa, thread_count(), {}, "M/s", 0, {}, choice.backend};
    const double need = per_particle[c.material] * static_cast<double>(c.particles()),
                 free = static_cast<double>(device_of(choice)->free);
    if (need > free)
      row.note =
          fmt::format("needs some {:.1f} GB of the device's memory, {:.1f} are free", gigabytes(need), gigabytes(free));
    else
      measure(c, options, choice, row, per_particle[c.material]);
    if (options.each) options.each(row);
    rows.push_back(std::move(row));
  }
  if (constexpr DeviceCase c{"newtonian", million}; c.particles() <= options.largest) {
    rows.push_back(frame_row(Course(column_scene(*find_material(c.material), c.cells), choice), choice, isa));
    if (options.each) options.each(rows.back());
  }
  return rows;
}

}  // namespace dreampm
