// A run as files of other programs (exchange/): particles, meshes, colliders and camera, frame by
// frame.
#pragma once
#include "dreampm/export/clip.h"
#include "dreampm/pipeline/run_folder.h"

namespace dreampm {

struct ExportOptions {
  std::string format;          ///< a name of exchange::formats()
  exchange::Axes axes;         ///< scale above 0
  int first = 0, last = 0;     ///< frames, both included; 0, 0: all
  std::filesystem::path out;   ///< a file, or the folder of a format of several; empty: RUN/export/...
  bool particles = true;       ///< or not
  bool surface = true;         ///< or not
  bool foam = true;            ///< of a scene with foam, or not
  bool colliders = true;       ///< and rigid bodies, or not
  bool what_there_is = false;  ///< surfaces that are not made are left out, not refused
};

struct ExportResult {
  std::vector<std::filesystem::path> files;  ///< or the folder of them
  std::size_t frames = 0;
  std::size_t meshes = 0, objects = 0;  ///< in each frame: surfaces; colliders and rigid bodies
  bool particles = false;
};

/// Reads the run's particles and surfaces and writes them. Throws InputError for a frame that is
/// not simulated, surfaces that are missing or not up to date, nothing to write, and a place that
/// cannot be written; Interrupted between frames: then files of the frames before are whole, and a
/// file of all frames is as it was.
ExportResult export_run(const RunFolder& run, const ExportOptions& options);

}  // namespace dreampm
