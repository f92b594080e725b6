// The rows of probes, a CSV file each.
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "dreampm/io/series.h"

namespace dreampm {

/// A probe, as its file names it.
struct ProbeColumns {
  std::string name;
  std::vector<std::string> columns;  ///< without the time
};

/// NAME.csv in a folder, for each probe.
class ProbeWriter {
 public:
  ProbeWriter(std::vector<ProbeColumns> probes, std::filesystem::path folder)
      : probes_(std::move(probes)), folder_(std::move(folder)) {}
  /// Begins new files.
  void begin();
  /// Removes all CSV files of the folder, which is that of a run: those of probes that it had.
  void remove_earlier() const;
  /// Goes on at `time` [s]: rows after it are cut. Throws InputError where a file is gone.
  void go_on(double time);
  /// A row of a probe, by its number.
  void append(std::size_t probe, double time, const std::vector<double>& row) { files_[probe]->append(time, row); }

 private:
  std::filesystem::path file_of(const ProbeColumns& probe) const { return folder_ / (probe.name + ".csv"); }

  std::vector<ProbeColumns> probes_;
  std::filesystem::path folder_;
  std::vector<std::unique_ptr<SeriesWriter>> files_;  ///< by probe
};

}  // namespace dreampm
