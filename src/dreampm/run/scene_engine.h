// A scene in an engine: assembled, probed and begun, in one place for the command, programs,
// validation and bench.
#pragma once
#include <filesystem>
#include <memory>
#include <string>

#include "dreampm/run/engine.h"
#include "dreampm/run/probe_sampler.h"
#include "dreampm/setup/assemble.h"

namespace dreampm {

template <class R>
class SceneEngine {
 public:
  /// Assembles the scene, makes its probes, and an engine of its empty world. `file` names the
  /// scene in messages. Throws InputError as `assemble` and ProbeSet do.
  SceneEngine(const model::Scene& scene, const std::string& file, std::unique_ptr<Backend<R>> backend)
      : SceneEngine(scene, file, assemble(scene, file), std::move(backend)) {}
  /// The same of a scene that was assembled before.
  SceneEngine(const model::Scene& scene, const std::string& file, InitialState start,
              std::unique_ptr<Backend<R>> backend);
  SceneEngine(const SceneEngine&) = delete;
  SceneEngine& operator=(const SceneEngine&) = delete;

  /// Brings in the first matter: the seeds of `start`, or what the scene's own start says. Where
  /// the scene is as it was when that was written, the future is the same to the bit; else the grid
  /// is formed anew, of the same particles. Throws InputError for a start of another spacing, space
  /// or precision, or without one of the scene's materials, and for a time.dt that cannot work.
  void begin();
  /// Goes on with a world of a checkpoint, in place of `begin`. Throws InputError where a probe is
  /// not in the memories.
  void go_on(World<R> saved, const ProbeMemories& memories);

  Engine<R>& engine() { return engine_; }
  const Engine<R>& engine() const { return engine_; }
  ProbeSampler<R>& probes() { return probes_; }
  /// Returns the assembled scene. Until `begin` its seeds may be changed; nothing needs them later.
  InitialState& start() { return start_; }

 private:
  InitialState start_;
  std::string dt_place_;  ///< of time.dt in the scene, for messages
  std::string moment_;    ///< the file of its start, or empty
  model::Time time_;
  Engine<R> engine_;
  ProbeSampler<R> probes_;
};

}  // namespace dreampm
