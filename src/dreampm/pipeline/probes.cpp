#include "dreampm/pipeline/probes.h"

#include "dreampm/base/file.h"

namespace dreampm {
namespace fs = std::filesystem;

template <class R>
void ProbeFiles<R>::begin() {
  if (fs::is_directory(folder_))
    for (const auto& old : fs::directory_iterator(folder_))
      if (old.path().extension() == ".csv") fs::remove(old);
  files_.clear();
  if (set_.size() > 0) make_folder(folder_);
  for (std::size_t p = 0; p < set_.size(); ++p)
    files_.push_back(std::make_unique<SeriesWriter>(file_of(p), set_.columns(p)));
}

template <class R>
void ProbeFiles<R>::resume(const ProbeMemories& memories, double time) {
  set_.resume(memories, time);
  files_.clear();
  for (std::size_t p = 0; p < set_.size(); ++p)
    files_.push_back(std::make_unique<SeriesWriter>(file_of(p), set_.columns(p), time));
}

template class ProbeFiles<float>;
template class ProbeFiles<double>;

}  // namespace dreampm
