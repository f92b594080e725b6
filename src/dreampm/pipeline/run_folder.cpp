#include "dreampm/pipeline/run_folder.h"

#include <fmt/format.h>

#include <algorithm>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/io/numbered.h"
#include "dreampm/pipeline/chunk.h"
#include "dreampm/scene/parse.h"

namespace dreampm {
namespace fs = std::filesystem;

std::vector<int> RunFolder::frames() const {
  std::vector<int> list;
  for (const FrameRecord& f : record.frames)
    if (f.frame <= scene.time.frames) list.push_back(f.frame);
  return list;
}

std::vector<int> RunFolder::chosen(int first, int last) const {
  if (first == 0 && last == 0) return frames();
  std::vector<int> list;
  for (int f = first; f <= last; ++f) {
    state_hash(f);  // throws if it is not simulated
    list.push_back(f);
  }
  return list;
}

std::string RunFolder::state_hash(int frame) const { return frame_record(frame).state_hash; }

const FrameRecord& RunFolder::frame_record(int frame) const {
  for (const FrameRecord& f : record.frames)
    if (f.frame == frame) return f;
  fail_input("{}: frame {} is not simulated; it has {} frames", folder.string(), frame, record.frames.size());
}

fs::path RunFolder::particles(int frame) const { return folder / "particles" / numbered("particles", frame, ".ply"); }

void refuse_to_replace(const fs::path& folder) {
  if (!fs::exists(folder / "run.json")) return;
  const fs::path checkpoint = folder / "checkpoint";
  const bool can_go_on =
      fs::is_directory(checkpoint) && std::any_of(fs::directory_iterator(checkpoint), fs::directory_iterator(),
                                                  [](const auto& file) { return file.path().extension() == ".h5"; });
  RunRecord earlier;
  try {
    earlier = RunRecord::load(folder / "run.json");
  } catch (const InputError&) {
    if (!can_go_on) return;  // nothing is known of it
  }
  const auto stage = earlier.stages.find("simulate");
  const bool whole = stage != earlier.stages.end() && stage->second.status == "complete";
  if (!whole && !can_go_on) return;
  const std::size_t frames = earlier.frames.size();
  fail_input(
      "{}: has {}an earlier run, which {}: go on with it by --resume, replace it by --overwrite, or name another "
      "folder by --out",
      folder.string(), frames > 0 ? fmt::format("{} frame{} of ", frames, frames == 1 ? "" : "s") : "",
      whole ? "is whole" : "can go on");
}

RunFolder open_run(const fs::path& folder, Access access) {
  if (!fs::is_directory(folder)) fail_input("{}: no such folder; dreampm run SCENE makes one", folder.string());
  for (const char* file : {"scene.yaml", "run.json"})
    if (!fs::exists(folder / file))
      fail_input("{}: has no {}: not a run's folder; dreampm run SCENE makes one", folder.string(), file);
  RunFolder run;
  run.folder = folder;
  if (access == Access::write) run.lock = std::make_shared<RunLock>(folder);
  scene::ParseOptions options;
  options.of_run = true;
  run.scene = scene::load_scene(folder / "scene.yaml", options);
  run.record = RunRecord::load(folder / "run.json");
  if (run.lock) fold_chunks(folder, run.record);
  return run;
}

FrameTable RunFolder::table(const std::string& stage) const {
  return {folder / stage / "frames.csv", chunk_tables(folder, stage),
          chunk.empty() ? fs::path() : chunk / (stage + ".csv")};
}

void RunFolder::save_record() const {
  if (chunk.empty()) return record.save(folder / "run.json");
  RunRecord part = record;
  part.frames.clear();  // the run has them
  part.save(chunk / "run.json");
}

}  // namespace dreampm
