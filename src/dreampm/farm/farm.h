// Scenes as a job for a farm: written into a folder with all that the tasks read.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "dreampm/farm/formats.h"
#include "dreampm/model/scene.h"

namespace dreampm::farm {

struct FarmOptions {
  std::string source;               ///< of the scene, for messages
  std::filesystem::path folder;     ///< of the job; of a single scene also that of its run
  std::string to;                   ///< a name of formats()
  int chunk = 10;                   ///< frames a task
  std::string program = "dreampm";  ///< what machines start
  std::string backend;              ///< of the simulation; empty: the default
  std::string isa = "auto";         ///< instruction set of the simulation
  int threads = 0;                  ///< of a task; 0: all cores
};

/// A job as it was written.
struct WrittenJob {
  std::filesystem::path file;
  std::string start;  ///< a line of a shell that starts it
};

/// Writes the job of a scene: FOLDER/farm/scene.yaml with its models by their hash, and the
/// format's file. Throws InputError for a scene that a later stage would refuse and for a model
/// that cannot be read; then nothing is written.
WrittenJob write_job(const model::Scene& scene, const FarmOptions& options);

/// The same of several scenes, by the names of their runs: FOLDER/farm/NAME.yaml, runs in
/// FOLDER/NAME, and a table at the end (wedge.h).
struct NamedScene {
  std::string name;
  model::Scene scene;
};
WrittenJob write_wedge_job(const std::string& name, const std::vector<NamedScene>& scenes, const FarmOptions& options);

}  // namespace dreampm::farm
