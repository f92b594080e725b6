// A scene of scenes/validation, assembled and stepped in this process.
#pragma once
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "dreampm/backend/backend.h"
#include "dreampm/backend/reference/reference.h"
#include "dreampm/base/interrupt.h"
#include "dreampm/run/scene_engine.h"
#include "validate/case.h"
#include "validate/measure/table.h"
#include "validate/set_up.h"

namespace dreampm::validate {

/// The text of scenes/validation/NAME.yaml as it was built in, and the names there are. Throws
/// InputError.
std::string scene_text(std::string_view name);
std::vector<std::string> scene_names();
/// scenes/validation/data/NAME. Throws InputError.
Table reference_table(std::string_view name);

/// Parses a built-in scene; `overrides` as with --set. Throws InputError.
model::Scene built_in_scene(std::string_view name, const std::vector<std::string>& overrides = {});

/// Returns the overrides with which the projection runs a scene of water, on particles that do not
/// lie in a lattice.
std::vector<std::string> by_projection(std::string_view body, const std::vector<std::string>& more = {});

/// Makes the backend of the runs in float. Throws InputError for one that computes in double, and
/// as make_backend does.
std::unique_ptr<Backend<float>> float_backend(const Options& options);

/// R = float runs on the backend of the options, double on the reference.
template <class R>
class ValidationRun {
 private:
  Trial& trial_;
  SceneEngine<R> scene_;
  static std::unique_ptr<Backend<R>> make_backend(const Options& options) {
    if constexpr (sizeof(R) == sizeof(float))
      return float_backend(options);
    else
      return make_reference_backend<R>();
  }

 public:
  ValidationRun(Trial& trial, std::string_view scene, const std::vector<std::string>& overrides = {})
      : ValidationRun(trial, built_in_scene(scene, overrides)) {}
  ValidationRun(Trial& trial, const model::Scene& scene)
      : trial_(trial),
        scene_(scene, scene.name, make_backend(trial.options())),
        world(scene_.engine().world()),
        seeds(scene_.start().seeds) {
    trial.set_up(scene.name, set_up_of(scene, scene_.start().world));
  }

  World<R>& world;
  std::vector<std::vector<ParticleSeed>>& seeds;  ///< by set; what a case may still move before `begin`

  /// True if liquids are pressed by their own weight, and not by a projection.
  bool compresses() const { return world.settings.solver == SolverKind::explicit_steps; }
  Engine<R>& engine() { return scene_.engine(); }
  Backend<R>& backend() { return engine().backend(); }
  /// Every seed, ids ascending from 0.
  std::vector<ParticleSeed> all_seeds() const {
    std::vector<ParticleSeed> all;
    for (const auto& set : seeds) all.insert(all.end(), set.begin(), set.end());
    std::sort(all.begin(), all.end(), [](const ParticleSeed& a, const ParticleSeed& b) { return a.id < b.id; });
    return all;
  }
  void begin() {
    scene_.begin();
    engine().download(MatterFields::all);
  }
  /// Makes a step. Between steps a case may read and change anything. `motion` is filled at the end
  /// of a frame, and from `next_sample_time` [s] on.
  StepSums step(Motion<R>* motion = nullptr, double next_sample_time = std::numeric_limits<double>::infinity()) {
    if (interrupted()) throw Interrupted("interrupted; cases that were done are reported");
    trial_.cost(world.particles());
    engine().upload(MatterFields::all);
    const StepSums sums = engine().step(motion ? next_sample_time : never);
    engine().download(MatterFields::all);
    if (motion && engine().motion_is_current()) *motion = engine().motion();
    return sums;
  }
  /// Steps until world.time reaches `time` [s], calling each(report) after every step.
  template <class Each>
  void until(double time, const Each& each) {
    while (world.time < time) each(step());
  }
  void until(double time) {
    until(time, [](const StepSums&) {});
  }
  /// Steps until `time` [s] and calls look() where a frame ends, and at last.
  template <class Look>
  void watch_until(double time, const Look& look) {
    until(time, [&](const StepSums& report) {
      if (report.frame_done || !(world.time < time)) look();
    });
  }
};

}  // namespace dreampm::validate
