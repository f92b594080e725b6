// How long drawing takes, here and now.
#pragma once
#include <string>
#include <string_view>

namespace dreampm::gl {

struct DrawingBenchOptions {
  int particles = 65536;
  int width = 1280, height = 720;  ///< pixels
  int frames = 20;                 ///< counted, after two that are not
  std::string_view look = "spheres";
};

struct DrawingBenchResult {
  std::string driver;
  double cpu_ms = 0;   ///< a frame, the median: processor time of all threads: on a software driver also its drawing
  double wall_ms = 0;  ///< a frame, the median: until it is drawn
};

/// Draws a pool of that number of particles in the unit box, in a context of its own. Throws
/// RunError where there is no OpenGL 3.3, InputError for a look that is not there.
DrawingBenchResult bench_drawing(const DrawingBenchOptions& options);

}  // namespace dreampm::gl
