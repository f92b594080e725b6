// The runs of a wedge, made on this machine.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "dreampm/farm/wedge.h"

namespace dreampm::farm {

struct WedgeOptions {
  std::filesystem::path folder;    ///< of the wedge
  std::filesystem::path program;   ///< dreampm
  std::vector<std::string> scene;  ///< what `dreampm make` is called with, without the values: the file, ..
  std::vector<int> frames;         ///< of each run, for the progress
  int jobs = 1;                    ///< runs at once
};

/// Makes every run in a process of its own, by `dreampm make` in FOLDER/NAME, whose words go to
/// FOLDER/log/NAME.txt; then, and where it is interrupted or runs fail, writes the table and the
/// contact sheet. What is up to date is left. Throws InputError where another process works in the
/// folder; RunError naming the runs that failed, once all others are done; after Interrupted the
/// same call goes on.
void make_wedge(const Wedge& wedge, const WedgeOptions& options);

/// Writes wedge.csv, so that the folder says what its runs are.
void begin_table(const Wedge& wedge, const std::filesystem::path& folder);

/// Writes wedge.csv and contact-sheet.png of the runs as they are, and returns the table for a
/// person.
std::string write_table(const Wedge& wedge, const std::filesystem::path& folder);

}  // namespace dreampm::farm
