#include "dreampm/pipeline/checkpoint_writer.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "dreampm/base/error.h"
#include "dreampm/base/log.h"
#include "dreampm/io/numbered.h"
#include "dreampm/pipeline/estimate.h"
#include "dreampm/setup/assemble.h"

namespace dreampm {
namespace fs = std::filesystem;

std::vector<fs::path> checkpoints_in(const fs::path& folder) {
  std::vector<fs::path> files;
  if (fs::is_directory(folder))
    for (const auto& entry : fs::directory_iterator(folder))
      if (entry.path().extension() == ".h5") files.push_back(entry.path());
  std::sort(files.begin(), files.end(), std::greater<>());
  return files;
}

template <class R>
std::optional<SavedRun<R>> newest_checkpoint(const fs::path& folder, const World<double>& empty,
                                             const std::string& scene_hash) {
  const std::vector<fs::path> files = checkpoints_in(folder);
  for (const fs::path& file : files) {
    SavedRun<R> saved{file, as_world<R>(empty), {}};
    try {
      saved.info = load_checkpoint(file, scene_hash, saved.world);
      return saved;
    } catch (const OtherPrecision&) {
      throw;  // so are those before it
    } catch (const InputError& e) {
      if (file == files.back())
        fail_input("{}; no other checkpoint is left: without {} the run starts again", e.what(), folder.string());
      warn("{}; trying the checkpoint before it", e.what());
    }
  }
  return std::nullopt;
}

template <class R>
void CheckpointWriter<R>::on_frame() {
  const int frame = engine_.world().frame;
  if ((when_.every > 0 && frame % when_.every == 0) || frame == when_.last) write();
}

template <class R>
void CheckpointWriter<R>::write() {
  engine_.download(MatterFields::all);
  const World<R>& world = std::as_const(engine_).world();
  save_checkpoint(folder_ / numbered("checkpoint", world.frame, ".h5"), world,
                  {scene_hash_, std::string(engine_.backend().name()), std::string(engine_.backend().isa()),
                   totals_.carried(), totals_.particle_steps(), probes_.memories()});
  const auto files = checkpoints_in(folder_);
  for (std::size_t i = checkpoints_kept; i < files.size(); ++i) fs::remove(files[i]);
}

template std::optional<SavedRun<float>> newest_checkpoint(const fs::path&, const World<double>&, const std::string&);
template std::optional<SavedRun<double>> newest_checkpoint(const fs::path&, const World<double>&, const std::string&);
template class CheckpointWriter<float>;
template class CheckpointWriter<double>;

}  // namespace dreampm
