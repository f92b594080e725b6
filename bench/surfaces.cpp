#include "bench/surfaces.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <utility>

#include "bench/course.h"
#include "dreampm/base/parallel.h"
#include "dreampm/geometry/region.h"
#include "dreampm/io/ply.h"
#include "dreampm/math/rng.h"
#include "dreampm/surface/surface.h"

namespace dreampm {
namespace {

/// m
constexpr Vec3f basin{2, 1, 1};

bool in_liquid(const Vec3f& p) {
  const float wave = 0.4f + 0.1f * std::sin(7 * p.x) * std::cos(6 * p.z) + 0.04f * std::sin(31 * p.x + 3 * p.z);
  const float x = p.x - 0.7f, z = p.z - 0.5f, r = std::sqrt(x * x + z * z);
  const float top = 0.7f + 0.06f * std::sin(20 * std::atan2(z, x));
  const bool crown = std::abs(r - 0.25f - 0.1f * (p.y - 0.45f)) < 0.012f && p.y < top;
  const bool film = p.x > 1.97f && p.y < 0.8f;
  return p.y < wave || crown || film;
}

/// A splash on a jittered lattice, and drops in the air, a fiftieth of all.
std::vector<Vec3f> splash(float h) {
  std::vector<Vec3f> points;
  std::uint64_t n = 0;
  const auto count = [&](float s) { return static_cast<int>(std::lround(s / h)); };
  for (int k = 0; k < count(basin.z); ++k)
    for (int j = 0; j < count(basin.y); ++j)
      for (int i = 0; i < count(basin.x); ++i) {
        const auto off = [&] { return 0.5f + 0.35f * (2 * static_cast<float>(uniform(1, n++)) - 1); };
        const float x = off(), y = off(), z = off();
        const Vec3f p = Vec3f{static_cast<float>(i) + x, static_cast<float>(j) + y, static_cast<float>(k) + z} * h;
        if (in_liquid(p)) points.push_back(p);
      }
  for (std::uint64_t i = 0, spray = points.size() / 50; i < spray; ++i)
    points.push_back(
        static_cast<Vec3f>(Vec3d{2 * uniform(7, 3 * i), 0.5 + 0.45 * uniform(7, 3 * i + 1), uniform(7, 3 * i + 2)}));
  return points;
}

std::vector<WettedSolid> pillar_and_ball() {
  std::vector<WettedSolid> solids;
  for (const Shape& s : {Shape::cylinder({1.5, 0.4, 0.5}, 0.15, 1), Shape::sphere({0.3, 0.25, 0.7}, 0.15)})
    solids.push_back({make_region(s, 0.01, {}), {}});
  return solids;
}

double seconds_since(std::chrono::steady_clock::time_point then) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - then).count();
}

}  // namespace

std::vector<BenchRow> bench_surface(const SurfaceBenchOptions& options) {
  // The liquid fills 0.418 of the basin.
  const float h = std::cbrt(0.418f * basin.x * basin.y * basin.z / static_cast<float>(options.particles));
  const std::vector<Vec3f> points = splash(h), velocities(points.size(), Vec3f{1, 0, 0});
  SurfaceInput input{.positions = points,
                     .velocities = velocities,
                     .spacing = h,
                     .walls = {{0, 0, 0}, basin},
                     .is_wall = {true, true, true, false, true, true}};
  if (options.solids) input.solids = pillar_and_ball();
  if (!options.write.empty()) {
    TriMesh cloud;
    cloud.vertices = points;
    write_mesh(options.write, cloud, {});
  }
  const ThreadLimit limit(options.threads);
  std::vector<std::pair<std::string, std::vector<double>>> stages;
  std::vector<double> all;
  std::size_t vertices = 0;
  for (int round = 0; round < options.rounds; ++round) {
    std::size_t stage = 0;
    const auto begun = std::chrono::steady_clock::now();
    auto last = begun;
    SurfaceSettings settings;
    settings.voxel = static_cast<float>(options.voxel) * h;
    settings.overlap = 0.5f;
    settings.ended = [&](std::string_view name) {
      if (round == 0) stages.push_back({std::string(name), {}});
      stages[stage++].second.push_back(seconds_since(last));
      last = std::chrono::steady_clock::now();
    };
    vertices = reconstruct(input, settings).mesh.vertices.size();
    all.push_back(seconds_since(begun));
  }
  std::vector<BenchRow> rows;
  const auto add = [&](std::string what, const std::vector<double>& seconds, std::string note) {
    const auto [least, most] = std::minmax_element(seconds.begin(), seconds.end());
    const double median = median_of(seconds);
    rows.push_back({std::move(what), points.size(), "", options.threads, median, "s",
                    median > 0 ? (*most - *least) / median : 0, std::move(note)});
  };
  for (const auto& [name, seconds] : stages)
    add("surface: " + name, seconds, fmt::format("{:.1f} % of all", 100 * median_of(seconds) / median_of(all)));
  add("surface", all, fmt::format("{} vertices, spacing {:.4g} m, voxel {:.3g} spacings", vertices, h, options.voxel));
  return rows;
}

}  // namespace dreampm
