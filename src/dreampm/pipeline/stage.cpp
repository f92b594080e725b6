#include "dreampm/pipeline/stage.h"

#include <algorithm>
#include <chrono>
#include <new>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/base/interrupt.h"
#include "dreampm/base/log.h"
#include "dreampm/base/progress.h"
#include "dreampm/pipeline/chunk.h"
#include "dreampm/pipeline/simulate.h"

namespace dreampm {
namespace fs = std::filesystem;
namespace {

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// Which of the files is not there, as a reason; empty if all are.
std::string missing(const std::vector<fs::path>& files) {
  for (const fs::path& f : files)
    if (!fs::exists(f)) return fmt::format("{} is not there", f.filename().string());
  return {};
}

void remove_leftovers(const StageWork& work, int frame) {
  if (!work.leftovers) return;
  const std::vector<fs::path> products = work.products(frame);
  for (const fs::path& f : work.leftovers(frame))
    if (std::find(products.begin(), products.end(), f) == products.end()) fs::remove(f);
}

/// Where the last call was cut off after its last frame, or another one made the rest.
void record_complete(RunFolder& run, const std::string& stage) {
  if (run.record.stages[stage].status == "complete") return;
  run.record.end_stage(stage, "complete");
  run.save_record();
}

/// A run that was opened to be read, and is worked on.
void hold(RunFolder& run) {
  if (run.lock) return;
  run.lock = std::make_shared<RunLock>(run.folder);
  fold_chunks(run.folder, run.record);
}

}  // namespace

StageCost::StageCost(RunFolder& run, std::string stage)
    : run_(run), stage_(run.record.stages[stage]), before_(stage_.seconds.value_or(0)), start_(now()) {}

void StageCost::frames(std::size_t count, const std::string& settings_hash) {
  stage_.frames = count;
  stage_.settings_hash = settings_hash;
}

void StageCost::save() {
  stage_.seconds = before_ + now() - start_;
  stage_.peak_memory_bytes = std::max(stage_.peak_memory_bytes.value_or(0), peak_memory_bytes());
  run_.save_record();
}

StageCost::~StageCost() {
  try {
    save();
  } catch (const Error& e) {
    warn("{}", e.what());
  }
}

void record_end(RunFolder& run, const std::string& stage, bool all_frames, const std::function<void()>& work) {
  hold(run);
  const std::optional<std::string> complete = all_frames ? std::optional<std::string>("complete") : std::nullopt;
  try {
    work();
    run.record.end_stage(stage, complete);
  } catch (const Interrupted&) {
    run.record.end_stage(stage, "interrupted");
    throw;
  } catch (const std::bad_alloc&) {
    run.record.end_stage(stage, "failed", "out of memory");
    throw;
  } catch (const std::exception& e) {
    run.record.end_stage(stage, "failed", e.what());
    throw;
  }
}

std::string not_up_to_date(const RunFolder& run, const std::string& stage, const std::vector<int>& frames,
                           const std::function<Identity(int frame)>& identity) {
  const FrameTable table = run.table(stage);
  for (const int f : frames) {
    const std::string why = table.why_redo(f, identity(f));
    if (!why.empty())
      return fmt::format("{}: the {} of frame {} is {}; dreampm {} {} makes it", run.folder.string(),
                         stage == "render" ? "picture" : stage, f, why == "new" ? "missing" : "not up to date: " + why,
                         stage, run.folder.string());
  }
  return {};
}

StageResult run_stage(RunFolder& run, const StageWork& work) {
  hold(run);
  const fs::path folder = run.folder / work.name;
  make_folder(folder);
  FrameTable table = run.table(work.name);
  if (work.all_frames)
    for (const int f : table.frames())
      if (std::find(work.frames.begin(), work.frames.end(), f) == work.frames.end()) {
        table.remove(f);
        for (const fs::path& file : work.products(f)) fs::remove(file);
        remove_leftovers(work, f);
      }

  StageResult result;
  std::vector<int> todo;
  bool again = false;
  for (const int f : work.frames) {
    std::string why = table.why_redo(f, work.identity(f));
    if (why.empty()) why = missing(work.products(f));
    if (why.empty()) continue;
    todo.push_back(f);
    if (why != "new" && !again) result.why = why, again = true;
    if (result.why.empty()) result.why = why;
  }
  if (todo.empty()) {
    if (work.all_frames) record_complete(run, work.name);
    return result;
  }

  const LogFile log(run.log_file());
  const std::size_t total = work.frames.size(), kept = total - todo.size();
  if (again)
    info("{}: {}: {} of {} frames again", work.name, result.why, todo.size(), total);
  else if (kept > 0)
    info("{}: going on, {} of {} frames are there", work.name, kept, total);
  StageCost cost(run, work.name);
  Progress progress(work.name + ": frame", total);
  const auto make = [&](int f) {
    if (interrupted())
      throw Interrupted(fmt::format("{}: interrupted before frame {}; the frames before it are kept", work.name, f));
    progress.update(kept + static_cast<std::size_t>(result.made));
    table.remove(f);
    work.make(f);
    remove_leftovers(work, f);
    table.enter(f, work.identity(f));
    ++result.made;
    cost.frames(table.frames().size(), work.settings_hash);
    if (result.made % 10 == 0) cost.save();
  };
  record_end(run, work.name, work.all_frames, [&] { std::for_each(todo.begin(), todo.end(), make); });
  progress.update(total);
  return result;
}

}  // namespace dreampm
