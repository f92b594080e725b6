// Numbers over time in a CSV file: what a probe writes.
#pragma once
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace dreampm {

struct Series {
  std::vector<std::string> columns;       ///< "time" first
  std::vector<std::vector<double>> rows;  ///< times rise
  /// The numbers of a column. Throws InputError if there is none of that name.
  std::vector<double> column(const std::string& name) const;
};

/// Reads a series back. A last line without its end (a killed run) is dropped; anything else wrong
/// is an InputError with file and line.
Series read_series(const std::filesystem::path& file);

/// Writes rows as they come; each row is in the file when append returns.
class SeriesWriter {
 public:
  /// `columns`: without the time. Starts a new file; with `keep_until`, keeps the rows of an
  /// existing one up to that time [s] (a resumed run). Throws InputError if that file is missing,
  /// damaged or has other columns, RunError if it cannot be written.
  SeriesWriter(std::filesystem::path file, std::vector<std::string> columns,
               std::optional<double> keep_until = std::nullopt);
  /// Throws InputError if the row is not as wide as the columns or does not follow the row before
  /// it.
  void append(double time, std::span<const double> values);

 private:
  std::filesystem::path file_;
  std::vector<std::string> columns_;  ///< with the time
  std::optional<double> last_;
};

}  // namespace dreampm
