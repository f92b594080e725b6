// All stages in turn: scene file to film.
#pragma once
#include <filesystem>

#include "dreampm/pipeline/simulate.h"

namespace dreampm {

struct MakeOptions {
  std::filesystem::path folder;  ///< of the run
  int threads = 0;               ///< 0: all cores
  std::string isa = "auto";      ///< instruction set of the simulation; a run made with another starts again
};

/// Simulates, meshes, draws and encodes; every stage goes on where it stopped and leaves what is up
/// to date. Returns false if there was nothing to do. Reports why it makes something again. Throws
/// as the stages do; after Interrupted the same call goes on.
bool make(const model::Scene& scene, const SceneSource& source, const MakeOptions& options);

}  // namespace dreampm
