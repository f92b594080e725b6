// Watches a simulation: a table of the front of a dam break by frames, a stop of its own, and a
// picture of the end.
#include <dreampm/render.h>
#include <dreampm/simulation.h>

#include <algorithm>
#include <cstdio>

constexpr const char* scene = R"(
dreampm: 1
name: observer
space: {min: [0, 0, 0], max: [0.8, 0.4, 0.2], spacing: 0.0125}
time: {fps: 50}
materials: {water: {type: newtonian, preset: water}}
bodies:
  dam: {material: water, shape: {box: {min: [0, 0, 0], max: [0.2, 0.3, 0.2]}}}
)";

/// Lines of the library go to a list of the program, which also says when to stop.
class Watch final : public dreampm::Host {
 public:
  void info(const std::string&) override { ++lines; }
  void warning(const std::string& line) override { std::printf("warning: %s\n", line.c_str()); }
  bool stop_requested() override { return arrived; }
  int lines = 0;
  bool arrived = false;
};

int main() try {
  Watch watch;
  dreampm::Simulation simulation(dreampm::parse_scene(scene, "observer"), {.host = &watch});
  long steps = 0;
  simulation.on_step([&](const dreampm::StepReport&) { ++steps; });
  simulation.on_frame([&](const dreampm::FrameEvent& e) {
    float front = 0;
    for (const dreampm::Vec3f& p : simulation.particles("water").position) front = std::max(front, p.x);
    std::printf("frame %2d, t = %.2f s, %3llu steps: front at %.3f m\n", e.frame, e.time,
                static_cast<unsigned long long>(e.steps), front);
    watch.arrived = front > 0.7f;
  });
  try {
    simulation.advance_frames(100);
  } catch (const dreampm::Interrupted&) {
    std::printf("the front arrived after %ld steps\n", steps);
    watch.arrived = false;
  }
  dreampm::write_png("observer.png", dreampm::render(simulation, {.width = 480, .height = 270, .samples = 8}));
  const dreampm::TriMesh mesh = simulation.surface("water");
  std::printf("%zu triangles, observer.png\n", mesh.triangles.size());
} catch (const dreampm::Error& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return e.exit_code();
}
