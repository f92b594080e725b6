#include "dreampm/pipeline/chunk.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/base/log.h"
#include "dreampm/pipeline/frame_stages.h"
#include "dreampm/pipeline/picture_records.h"

namespace dreampm {
namespace fs = std::filesystem;
namespace {

std::vector<fs::path> chunks_in(const fs::path& folder) {
  std::vector<fs::path> found;
  if (!fs::is_directory(folder / "chunks")) return found;
  for (const auto& entry : fs::directory_iterator(folder / "chunks"))
    if (entry.is_directory()) found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  return found;
}

/// What a chunk's earlier calls cost; nothing of one that noted nothing yet.
std::map<std::string, StageRecord> stages_of(const fs::path& chunk) {
  if (!fs::exists(chunk / "run.json")) return {};
  try {
    return RunRecord::load(chunk / "run.json").stages;
  } catch (const InputError& e) {
    warn("{}; what these frames cost is not known", e.what());
    return {};
  }
}

/// True for a stage that the task that simulates makes of all frames.
bool is_of_the_run(const std::string& name) {
  const auto in_order = [&](const FrameStage& stage) { return stage.in_order && stage.name == name; };
  return name == "simulate" || std::ranges::any_of(frame_stages(), in_order);
}

void add_stage(RunRecord& record, const std::string& name, const StageRecord& part) {
  StageRecord& stage = record.stages[name];
  stage.seconds = stage.seconds.value_or(0) + part.seconds.value_or(0);
  stage.peak_memory_bytes = std::max(stage.peak_memory_bytes.value_or(0), part.peak_memory_bytes.value_or(0));
  if (part.settings_hash) stage.settings_hash = part.settings_hash;
  for (const VolumeRecord& v : part.volumes) {
    std::erase_if(stage.volumes, [&](const auto& o) { return o.frame == v.frame && o.material == v.material; });
    stage.volumes.insert(std::upper_bound(stage.volumes.begin(), stage.volumes.end(), v,
                                          [](const auto& a, const auto& b) { return a.frame < b.frame; }),
                         v);
  }
  for (const PictureRecord& p : part.pictures) enter_picture(stage.pictures, p);
  if (part.status) record.end_stage(name, part.status, part.cause);
}

}  // namespace

std::vector<fs::path> chunk_tables(const fs::path& folder, const std::string& stage) {
  std::vector<fs::path> tables;
  for (const fs::path& chunk : chunks_in(folder))
    if (fs::exists(chunk / (stage + ".csv"))) tables.push_back(chunk / (stage + ".csv"));
  return tables;
}

RunFolder open_chunk(const fs::path& folder, const FrameRange& frames) {
  open_run(folder);  // refuses what is no run before anything is made there
  const auto shared = std::make_shared<RunLock>(folder, LockKind::shared);
  RunFolder run = open_run(folder);
  run.chosen(frames.first, frames.last);
  run.chunk = folder / "chunks" / fmt::format("{:06}-{:06}", frames.first, frames.last);
  const auto own = std::make_shared<RunLock>(run.chunk);
  own->keep();
  using Locks = std::pair<std::shared_ptr<RunLock>, std::shared_ptr<RunLock>>;
  const auto both = std::make_shared<Locks>(shared, own);
  run.lock = std::shared_ptr<RunLock>(both, shared.get());
  const std::map<std::string, StageRecord> of_run = run.record.stages;
  run.record.stages = stages_of(run.chunk);
  for (const auto& [name, stage] : of_run)
    if (is_of_the_run(name)) run.record.stages[name] = stage;
  return run;
}

void fold_chunks(const fs::path& folder, RunRecord& record) {
  const std::vector<fs::path> chunks = chunks_in(folder);
  if (chunks.empty()) return;
  std::set<std::string> stages;
  std::string log;
  for (const fs::path& chunk : chunks) {
    for (const auto& entry : fs::directory_iterator(chunk))
      if (entry.path().extension() == ".csv") stages.insert(entry.path().stem().string());
    for (const auto& [name, stage] : stages_of(chunk))
      if (!is_of_the_run(name) && stage.seconds) add_stage(record, name, stage);
    if (fs::exists(chunk / "log.txt")) log += read_file(chunk / "log.txt");
  }
  for (const std::string& stage : stages) {
    const FrameTable table(folder / stage / "frames.csv", chunk_tables(folder, stage), {});
    table.fold();
    record.stages[stage].frames = table.frames().size();
  }
  if (!log.empty())
    replace_file_text(folder / "log.txt",
                      (fs::exists(folder / "log.txt") ? read_file(folder / "log.txt") : std::string()) + log);
  record.save(folder / "run.json");
  fs::remove_all(folder / "chunks");
}

}  // namespace dreampm
