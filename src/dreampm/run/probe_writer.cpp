#include "dreampm/run/probe_writer.h"

#include "dreampm/base/file.h"

namespace dreampm {
namespace fs = std::filesystem;

void ProbeWriter::remove_earlier() const {
  if (!fs::is_directory(folder_)) return;
  for (const auto& old : fs::directory_iterator(folder_))
    if (old.path().extension() == ".csv") fs::remove(old);
}

void ProbeWriter::begin() {
  files_.clear();
  if (!probes_.empty()) make_folder(folder_);
  for (const ProbeColumns& probe : probes_)
    files_.push_back(std::make_unique<SeriesWriter>(file_of(probe), probe.columns));
}

void ProbeWriter::go_on(double time) {
  files_.clear();
  for (const ProbeColumns& probe : probes_)
    files_.push_back(std::make_unique<SeriesWriter>(file_of(probe), probe.columns, time));
}

}  // namespace dreampm
