// A wedge: a scene once for every combination of some keys' values.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace dreampm::farm {

/// A key of the scene and what it shall be.
struct WedgeKey {
  std::string path;
  std::vector<std::string> values;
};

/// Of "KEY=a,b,c": commas within brackets, braces and quotes belong to a value. Throws InputError
/// naming the argument, for one that is not of this form and for a value that is there twice.
WedgeKey wedge_key(const std::string& argument);

struct WedgeRun {
  std::string name;                 ///< of its folder, of letters, digits and "=,._+-"
  std::vector<std::string> values;  ///< of the keys
  /// "KEY=VALUE" of each key.
  std::vector<std::string> settings(const std::vector<std::string>& keys) const;
};

struct Wedge {
  std::vector<std::string> keys;
  std::vector<WedgeRun> runs;
};

/// Every combination; the last key changes first. Names of runs depend on their values alone, so
/// that a wedge with more values keeps the runs of one with less. Throws InputError for a key that
/// is there twice and for more than 10,000 runs.
Wedge wedge_of(const std::vector<WedgeKey>& keys);

/// wedge.csv in the folder of a wedge: its keys, its runs, and what is known of them.
std::filesystem::path table_file(const std::filesystem::path& folder);

}  // namespace dreampm::farm
