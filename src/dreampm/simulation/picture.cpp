#include "dreampm/base/error.h"
#include "dreampm/pictures/draw.h"
#include "dreampm/pictures/wetted_solids.h"
#include "dreampm/render.h"
#include "dreampm/render/render.h"
#include "dreampm/simulation.h"
#include "dreampm/simulation/simulation_impl.h"

namespace dreampm {

RgbImage render(const Simulation& simulation, const PictureOptions& options) {
  const Simulation::Impl& impl = SimulationAccess::impl(simulation);
  model::Scene scene = simulation.scene().model();
  scene.bodies.insert(scene.bodies.end(), impl.state.added.begin(), impl.state.added.end());
  RenderSettings settings = render_settings(scene);
  settings.width = options.width.value_or(settings.width);
  settings.height = options.height.value_or(settings.height);
  settings.samples = options.samples.value_or(settings.samples);
  if (settings.samples < settings.min_samples)
    fail_input("samples is {}: must be {} or more", settings.samples, settings.min_samples);
  const ParticleFrame& frame = impl.frame();
  std::vector<BodyRecord> bodies;
  for (const BodyRange& b : impl.state.bodies) bodies.push_back({b.name, b.first_id, b.count});
  return impl.with_engine([&](const auto& engine) {
    // Within the exposure what has no path goes on as it moves now.
    std::vector<Pose> poses;
    FrameRecord now, after;
    now.time = engine.world().time, after.time = now.time + 1 / scene.time.fps;
    for (Collider c : engine.world().colliders) {
      poses.push_back(c.pose);
      if (c.path) continue;
      now.poses[c.name] = c.pose;
      c.advance(after.time - now.time);
      after.poses[c.name] = c.pose;
    }
    const ColliderModels models(scene, frame.shift);
    const double open = scene.render.camera.shutter / scene.time.fps;
    FrameContent content;
    content.particles = [&]() -> const ParticleFrame& { return frame; };
    content.mesh = [&](int material) {
      const MaterialParticles particles = particles_of(scene, material, frame);
      auto solids = wetted_solids(engine.world().colliders);
      return reconstruct(surface_input(scene, particles, frame.shift, std::move(solids)), surface_settings(scene)).mesh;
    };
    const DrawnColliders colliders = models.at(poses, now.time, models.motion_about(now, nullptr, &after, open));
    return tone_map(draw_frame(scene, frame.shift, bodies, content, colliders, settings));
  });
}

}  // namespace dreampm
