// All stages in turn: scene file to film. And the parts of that which several machines take on.
#pragma once
#include <filesystem>

#include "dreampm/pipeline/run_folder.h"
#include "dreampm/pipeline/simulate.h"

namespace dreampm {

struct MakeOptions {
  std::filesystem::path folder;  ///< of the run
  int threads = 0;               ///< 0: all cores
  /// A name of backend/registry.h; a run made with another starts again. Empty: that of the run,
  /// else the default.
  std::string backend{};
  std::string isa = "auto";  ///< instruction set of the simulation; a run made with another starts again
};

/// Simulates, meshes, draws and encodes; every stage goes on where it stopped and leaves what is up
/// to date. Returns false if there was nothing to do. Reports why it makes something again. Throws
/// as the stages do; after Interrupted the same call goes on.
bool make(const model::Scene& scene, const SceneSource& source, const MakeOptions& options);

/// The first part of make: particles, ledger, checkpoints, and stages whose frames follow from each
/// other. Returns, reports and throws as make does.
bool make_simulation(const model::Scene& scene, const SceneSource& source, const MakeOptions& options);

/// The second: the other stages of frame_stages.h, for some frames of a run that is simulated.
/// Others may make other frames of it at the same time, also on other machines. Throws InputError
/// where the folder holds no run of this very scene, for frames that are not simulated, and where
/// somebody makes these.
bool make_frames(const model::Scene& scene, const SceneSource& source, const MakeOptions& options,
                 const FrameRange& frames);

/// The last: the film and the contact sheet. Throws InputError where a frame is not made.
bool make_film(const model::Scene& scene, const SceneSource& source, const MakeOptions& options);

}  // namespace dreampm
