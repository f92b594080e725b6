// Observers that write files of a simulation while it runs: those that `dreampm run` writes.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace dreampm {

class Simulation;

/// A ledger: a row a frame of mass, momentum and energy, with the columns of
/// docs/reference/ledger.md. The first row is of the moment at which it is attached. Edits have no
/// column: over a frame with one that brings or takes matter, balances do not close.
struct LedgerFile {
  std::filesystem::path file;  ///< such as ledger.csv
};

/// A PLY file of all particles a frame, particles_NNNNNN.ply, the first at once.
struct ParticleFiles {
  std::filesystem::path folder;  ///< is made if it is not there
  /// Attributes in the file beside position, identity and material: velocity, f, j, jp, density,
  /// pressure, color.
  std::vector<std::string> attributes{"velocity"};
};

/// The rows of the scene's probes, those measured so far too: NAME.csv for each.
struct ProbeFiles {
  std::filesystem::path folder;  ///< is made where the scene has probes
};

/// Saved moments, as Simulation::save writes them: checkpoint_NNNNNN.yaml and what it starts from.
/// Simulation::load goes on from one.
struct CheckpointFiles {
  std::filesystem::path folder;  ///< is made if it is not there
  int every = 10;                ///< frames
  int keep = 2;                  ///< of them, the newest; 0: all
};

/// Writes from now on, for as long as the simulation lives. Files are written at the end of a
/// frame, before functions of `on_frame` are called, and are whole at any time; folders are made.
/// After `restore` and `load` files go on from that moment: rows of later ones are cut, and the row
/// of a frame that is under way then has the steps from there on. What the disk refuses throws
/// RunError out of the call that steps. Throws InputError for an attribute that is not there, and
/// numbers below 1 (`keep`: 0).
void attach(Simulation& simulation, const LedgerFile& ledger);
void attach(Simulation& simulation, const ParticleFiles& particles);
void attach(Simulation& simulation, const ProbeFiles& probes);
void attach(Simulation& simulation, const CheckpointFiles& checkpoints);

}  // namespace dreampm
