// Which frames of a stage are made, and what from.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace dreampm {

/// What a product depends on, as named hashes: {"simulation", ".."}, {"surface settings", ".."}.
using Identity = std::vector<std::pair<std::string, std::string>>;

/// Which frames of a stage exist, and what they were made from: STAGE/frames.csv. A frame is
/// entered after its files are whole and taken out before they are touched, so that a killed run
/// never leaves a wrong entry.
class FrameTable {
 public:
  /// Reads the file; one that is missing or damaged is an empty table.
  explicit FrameTable(std::filesystem::path file);
  /// The table as tasks of a farm left it: `parts` are their own files, which override `file`.
  /// Frames on which two parts differ are in neither. What changes from now on is written to `own`,
  /// one of the parts; into `file` if it is empty.
  FrameTable(std::filesystem::path file, const std::vector<std::filesystem::path>& parts, std::filesystem::path own);
  /// Empty if the frame was made from the same; else what changed since, or "new".
  std::string why_redo(int frame, const Identity& identity) const;
  void enter(int frame, const Identity& identity);
  void remove(int frame);
  std::vector<int> frames() const;
  /// Writes the table as it is, parts and all, to `file`.
  void fold() const { write(file_, rows_); }

 private:
  using Rows = std::map<int, Identity>;
  static Rows read(const std::filesystem::path& file);
  static void write(const std::filesystem::path& file, const Rows& rows);
  void save() const;
  std::filesystem::path file_, own_;
  Rows rows_;      ///< all
  Rows own_rows_;  ///< those of `own_`; of a frame that was taken out every hash is "-"
};

}  // namespace dreampm
