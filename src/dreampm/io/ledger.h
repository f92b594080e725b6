// ledger.csv: one row a frame of what is conserved, lost or received.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace dreampm {

/// One row. `values` holds a number for every column except frame and limiter.
struct LedgerRow {
  int frame = 1;
  std::string limiter = "frame";  ///< speed | wave | viscosity | frame | user
  std::map<std::string, double> values;
};

/// Every column of the format, in its order. A quantity that is not computed gets no column.
const std::vector<std::string>& ledger_columns();
/// The columns that stand after them in runs with emitters.
const std::vector<std::string>& inflow_columns();
/// Those that stand at the end in runs by a projection.
const std::vector<std::string>& projection_columns();

/// Writes rows as they come; each row is in the file when append returns.
class LedgerWriter {
 public:
  /// `columns`: "frame" first, then those that are computed. With `keep_until` 0 starts a new file;
  /// otherwise keeps the rows of an existing file up to that frame (a resumed run), whose columns
  /// must be the same. Throws InputError if the file is damaged or has other columns, RunError if
  /// it cannot be written.
  LedgerWriter(std::filesystem::path file, std::vector<std::string> columns, int keep_until = 0);
  /// Throws InputError if the row lacks a column, has one too many, or does not follow the row
  /// before it.
  void append(const LedgerRow& row);

 private:
  std::filesystem::path file_;
  std::vector<std::string> columns_;
  int last_frame_ = 0;
};

struct Ledger {
  std::vector<std::string> columns;
  std::vector<LedgerRow> rows;
};

/// Reads a ledger back. A last line without its end (a killed run) is dropped; anything else wrong
/// is an InputError with file and line.
Ledger read_ledger(const std::filesystem::path& file);

/// Shortest text that reads back to the same number: "0.1", "1e-300", "nan", "inf". A NaN has no
/// sign.
std::string exact_text(double value);

}  // namespace dreampm
