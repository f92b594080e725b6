#include "dreampm/gl/bench.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <vector>

#include "dreampm/gl/headless.h"
#include "dreampm/gl/renderer.h"

namespace dreampm::gl {

namespace {

double cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}
double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double median(std::vector<double>& values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// A quarter of the unit box, on a lattice that waves shift: as full as the scenes of the seed.
std::vector<Vec3f> blob(int count) {
  std::vector<Vec3f> points;
  points.reserve(static_cast<std::size_t>(count));
  const double spacing = std::cbrt(0.25 / count);
  const int across = static_cast<int>(std::ceil(1 / spacing));
  for (int k = 0; k < count; ++k) {
    const double x = (k % across + 0.5) * spacing, z = (k / across % across + 0.5) * spacing;
    const double y = (k / (across * across) + 0.5) * spacing * (1 + 0.3 * std::sin(7 * x + 2 * z) * std::cos(5 * z));
    points.push_back(Vec3f(Vec3d{x, y, z}));
  }
  return points;
}

}  // namespace

DrawingBenchResult bench_drawing(const DrawingBenchOptions& options) {
  const HeadlessContext context;
  Renderer renderer;
  const Framebuffer framebuffer(options.width, options.height);
  const std::vector<Vec3f> points = blob(options.particles);
  ParticleBatch batch;
  batch.position = points;
  batch.look = options.look;
  batch.spacing = static_cast<float>(std::cbrt(0.25 / options.particles));
  batch.radius = 0.01f;
  Picture picture;
  picture.particles = {&batch, 1};
  std::vector<double> cpu, wall;
  for (int k = -2; k < options.frames; ++k) {
    const double cpu_before = cpu_seconds(), wall_before = wall_seconds();
    renderer.draw(picture, Camera{}, framebuffer);
    glFinish();
    if (k < 0) continue;
    cpu.push_back(cpu_seconds() - cpu_before);
    wall.push_back(wall_seconds() - wall_before);
  }
  return {context.driver(), 1e3 * median(cpu), 1e3 * median(wall)};
}

}  // namespace dreampm::gl
