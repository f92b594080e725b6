#include "dreampm/pipeline/run_folder.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <sstream>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/io/numbered.h"
#include "dreampm/scene/parse.h"

namespace dreampm {
namespace fs = std::filesystem;
namespace {

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  return cells;
}

}  // namespace

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
  return run;
}

FrameTable::FrameTable(fs::path file) : file_(std::move(file)) {
  if (!fs::exists(file_)) return;
  std::istringstream in(read_file(file_));
  std::string line;
  if (!std::getline(in, line)) return;
  names_ = split(line);
  if (names_.empty() || names_[0] != "frame") return;
  names_.erase(names_.begin());
  while (std::getline(in, line)) {
    std::vector<std::string> cells = split(line);
    int frame = 0;
    // What cannot be read is made again.
    if (cells.size() != names_.size() + 1 ||
        std::from_chars(cells[0].data(), cells[0].data() + cells[0].size(), frame).ec != std::errc{})
      continue;
    cells.erase(cells.begin());
    rows_[frame] = std::move(cells);
  }
}

std::string FrameTable::why_redo(int frame, const Identity& identity) const {
  const auto row = rows_.find(frame);
  if (row == rows_.end()) return "new";
  for (std::size_t i = 0; i < identity.size(); ++i)
    if (i >= names_.size() || names_[i] != identity[i].first || row->second[i] != identity[i].second)
      return fmt::format("the {} changed", identity[i].first);
  return {};
}

void FrameTable::enter(int frame, const Identity& identity) {
  std::vector<std::string> names, row;
  for (const auto& [name, hash] : identity) names.push_back(name), row.push_back(hash);
  if (names != names_) rows_.clear();
  names_ = std::move(names);
  rows_[frame] = std::move(row);
  save();
}

void FrameTable::remove(int frame) {
  if (rows_.erase(frame) > 0) save();
}

std::vector<int> FrameTable::frames() const {
  std::vector<int> list;
  for (const auto& [frame, row] : rows_) list.push_back(frame);
  return list;
}

void FrameTable::save() const {
  std::string text = fmt::format("frame,{}\n", fmt::join(names_, ","));
  for (const auto& [frame, row] : rows_) text += fmt::format("{},{}\n", frame, fmt::join(row, ","));
  replace_file_text(file_, text);
}

}  // namespace dreampm
