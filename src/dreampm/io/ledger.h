// ledger.csv: one row a frame of what is conserved, lost or received.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "dreampm/io/ledger_columns.h"

namespace dreampm {

/// Writes rows as they come; each row is in the file when append returns.
class LedgerWriter {
 public:
  /// Starts a new file with `keep_until` 0; otherwise keeps the rows of an existing file up to that
  /// frame (a resumed run), whose columns must be those of the kind. Throws InputError if the file
  /// is damaged or has other columns, RunError if it cannot be written.
  LedgerWriter(std::filesystem::path file, const LedgerKind& kind, int keep_until = 0);
  /// Throws InputError if the row does not follow the row before it.
  void append(const LedgerRow& row);

 private:
  std::filesystem::path file_;
  std::vector<LedgerCell> cells_;
  int last_frame_ = 0;
};

struct Ledger {
  std::vector<std::string> columns;  ///< of the file; a row's member without one is as LedgerRow has it
  std::vector<LedgerRow> rows;
};

/// Reads a ledger back. A last line without its end (a killed run) is dropped; anything else wrong
/// is an InputError with file and line.
Ledger read_ledger(const std::filesystem::path& file);

/// Shortest text that reads back to the same number: "0.1", "1e-300", "nan", "inf". A NaN has no
/// sign.
std::string exact_text(double value);

}  // namespace dreampm
