// run.json: what a run is, how far it came, what it cost.
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "dreampm/math/vec.h"
#include "dreampm/pose.h"

namespace dreampm {

struct MachineRecord {
  std::string cpu;  ///< model name
  int cores = 0;    ///< that this process may use
  int threads = 0;  ///< used by the run
  std::string isa;  ///< instruction set of the kernels: "scalar", "avx2", ..
  std::uint64_t memory_bytes = 0;
};

struct FrameRecord {
  int frame = 1;    ///< from 1, the initial state
  double time = 0;  ///< s
  std::uint64_t substeps = 0;
  std::string state_hash;
  std::uint64_t particles = 0;
  std::uint64_t left = 0;  ///< particles that left through open walls so far
  /// The poses of rigid bodies by name, for the shape as the scene gives it.
  std::map<std::string, Pose> poses = {};
};

/// The volume that a frame's mesh encloses, beside the volume of its particles: at rest, and as
/// they lie.
struct VolumeRecord {
  int frame = 1;
  std::string material;
  double particles = 0, mesh = 0;  ///< m^3
  std::optional<double> taken;     ///< m^3; a record of an earlier version has none
};

/// What became of foam in a frame.
struct FoamRecord {
  int frame = 1;
  std::uint64_t crest = 0, trapped_air = 0, vorticity = 0;   ///< emitted since the frame before, by cause
  std::uint64_t beside_walls = 0;                            ///< of them, within a scale of a wall or collider
  Vec3d place{};                                             ///< m, the mean of where they were emitted
  std::uint64_t aged = 0, at_walls = 0, outside = 0;         ///< ended since, by what ended them
  std::uint64_t thinned = 0;                                 ///< not emitted, for the bound on how many there are
  std::uint64_t spray = 0, foam = 0, bubbles = 0, dust = 0;  ///< there now
  std::uint64_t emitted() const { return crest + trapped_air + vorticity; }
};

/// How a picture was sampled.
struct PictureRecord {
  int frame = 1;
  double samples = 0;   ///< a pixel, in the mean
  double error = 0;     ///< root mean square of the pixels' errors, to be compared with render.noise
  double at_limit = 0;  ///< the share of pixels that stopped at render.samples with a larger error
};

/// A stage that has not run has no fields set and is written as {}.
struct StageRecord {
  std::optional<double> seconds;
  std::optional<std::uint64_t> frames;
  std::optional<std::uint64_t> particle_steps;
  std::optional<std::uint64_t> peak_memory_bytes;
  std::optional<std::string> settings_hash;  ///< of the scene's keys this stage depends on: a rerun compares it
  std::vector<VolumeRecord> volumes;         ///< of the surface stage, by frame
  std::vector<FoamRecord> foam{};            ///< of the foam stage, by frame
  std::vector<PictureRecord> pictures{};     ///< of the render stage, by frame
  std::map<std::string, double> found{};     ///< of the foam stage: what the scene left to be found, by its key
  std::optional<std::string> status{};       ///< of its last call: complete | interrupted | failed
  std::optional<std::string> cause{};        ///< of its failure, in plain words
};

/// A body's particles: ids first_id to first_id + count - 1.
struct BodyRecord {
  std::string name;
  std::uint64_t first_id = 0, count = 0;
};

/// What computed a run up to a frame, before another backend or instruction set went on.
struct EarlierBackend {
  std::string backend, isa;
  int last_frame = 1;
};

struct RunRecord {
  static constexpr int format = 1;
  std::string dreampm;  ///< version that wrote it
  std::string commit;
  std::string scene;  ///< path of the scene file as given
  std::optional<std::string> variant;
  std::string scene_hash;
  std::string status = "interrupted";  ///< failed if a stage did; else how the simulation ended: complete | interrupted
  std::optional<std::string> cause;    ///< of the failure, in plain words
  std::optional<std::string> failed_stage{};  ///< the first stage that failed; "stage" in the file
  MachineRecord machine;
  std::uint64_t particles = 0;
  double spacing = 0;  ///< m
  double dx = 0;       ///< m
  Vec3d shift{};       ///< m, to add to the places in particle and surface files; zero near the origin
  std::string backend;
  std::vector<EarlierBackend> earlier_backends{};  ///< by rising frames; empty of a run that one backend computed
  std::vector<BodyRecord> bodies;  ///< in the order of the scene; a record of an earlier version has none
  std::vector<FrameRecord> frames;
  std::map<std::string, StageRecord> stages;  ///< simulate, foam, surface, render, video
  std::map<std::string, std::string> probes;  ///< type by name; their rows lie in probes/NAME.csv
  std::vector<std::string> warnings;

  /// A record with version and commit of this build and the five stages, none run.
  static RunRecord for_this_build();
  /// Records the end of a stage; status, cause and failed_stage follow from all of them.
  void end_stage(const std::string& stage, std::optional<std::string> status,
                 std::optional<std::string> cause = std::nullopt);
  std::string to_json() const;
  /// Throws InputError naming `source` and the key. Keys it does not know are skipped.
  static RunRecord from_json(const std::string& text, const std::string& source);
  /// Through replace_file.
  void save(const std::filesystem::path& file) const;
  static RunRecord load(const std::filesystem::path& file);
};

/// This machine; `isa` and `threads` are what the run uses.
MachineRecord this_machine(const std::string& isa, int threads);
/// Memory of this machine in bytes.
std::uint64_t machine_memory_bytes();
/// Memory that can still be had without swapping, in bytes (MemAvailable, and the control group's
/// limit).
std::uint64_t available_memory_bytes();
/// The most memory this process held at once so far, in bytes.
std::uint64_t peak_memory_bytes();
/// Returns the memory of this process, in bytes; 0 if the system does not say.
std::uint64_t resident_memory_bytes();
/// Makes peak_memory_bytes count anew. Returns false where the system cannot.
bool restart_peak_memory();

}  // namespace dreampm
