// The table of a wedge: what became of its runs.
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dreampm/farm/wedge.h"

namespace dreampm::farm {

/// What is known of a run. What is not known is absent.
struct WedgeRow {
  std::string status = "not run";  ///< then complete, interrupted or failed
  std::uint64_t frames = 0;        ///< simulated
  std::optional<std::uint64_t> particles, substeps;
  /// The volume that the particles of meshed materials take at the last frame over that at the
  /// first, each as a share of their rest volume.
  std::optional<double> volume_kept;
  std::optional<double> dt_min;                             ///< the shortest step [s]
  std::optional<double> seconds;                            ///< of all stages
  std::string state_hash;                                   ///< of the last frame
  std::vector<std::pair<std::string, std::string>> probes;  ///< "NAME.COLUMN" and its last value, as text
};

/// What the folder of a run says. Throws InputError for one that is damaged.
WedgeRow measure_run(const std::filesystem::path& folder);

/// The same of every run of the wedge in `folder`.
std::vector<WedgeRow> measure_wedge(const Wedge& wedge, const std::filesystem::path& folder);

/// A row a run: folder, the keys, status, then what was measured; every number in full.
std::string csv_text(const Wedge& wedge, const std::vector<WedgeRow>& rows);

/// Keys and runs of such a table. Throws InputError with file and line for another one.
Wedge read_wedge(const std::filesystem::path& file);

/// The table for a person, in columns.
std::string screen_text(const Wedge& wedge, const std::vector<WedgeRow>& rows);

/// What was measured of a run, as words: "volume 98.7 %", "dt 1.2e-04 s". For the contact sheet.
std::vector<std::string> measured_words(const WedgeRow& row);

}  // namespace dreampm::farm
