#include "dreampm/pipeline/frame_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <sstream>

#include "dreampm/base/file.h"

namespace dreampm {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view taken_out = "-";

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  return cells;
}

bool is_taken_out(const Identity& identity) {
  return std::all_of(identity.begin(), identity.end(), [](const auto& hash) { return hash.second == taken_out; });
}

Identity taken_out_of(const Identity& identity) {
  Identity out;
  for (const auto& part : identity) out.emplace_back(part.first, taken_out);
  return out;
}

std::vector<std::string> names_of(const Identity& identity) {
  std::vector<std::string> names;
  for (const auto& [name, hash] : identity) names.push_back(name);
  return names;
}

}  // namespace

FrameTable::Rows FrameTable::read(const fs::path& file) {
  Rows rows;
  if (!fs::exists(file)) return rows;
  std::istringstream in(read_file(file));
  std::string line;
  if (!std::getline(in, line)) return rows;
  std::vector<std::string> names = split(line);
  if (names.empty() || names[0] != "frame") return rows;
  names.erase(names.begin());
  while (std::getline(in, line)) {
    const std::vector<std::string> cells = split(line);
    int frame = 0;
    // What cannot be read is made again.
    if (cells.size() != names.size() + 1 ||
        std::from_chars(cells[0].data(), cells[0].data() + cells[0].size(), frame).ec != std::errc{})
      continue;
    Identity& row = rows[frame] = {};
    for (std::size_t i = 0; i < names.size(); ++i) row.emplace_back(names[i], cells[i + 1]);
  }
  return rows;
}

void FrameTable::write(const fs::path& file, const Rows& rows) {
  std::string text = "frame";
  if (!rows.empty())
    for (const std::string& name : names_of(rows.begin()->second)) text += "," + name;
  text += "\n";
  for (const auto& [frame, row] : rows) {
    text += std::to_string(frame);
    for (const auto& [name, hash] : row) text += "," + hash;
    text += "\n";
  }
  replace_file_text(file, text);
}

FrameTable::FrameTable(fs::path file) : FrameTable(std::move(file), {}, {}) {}

FrameTable::FrameTable(fs::path file, const std::vector<fs::path>& parts, fs::path own)
    : file_(std::move(file)), own_(std::move(own)), rows_(read(file_)) {
  Rows noted;
  for (const fs::path& part : parts)
    for (const auto& [frame, row] : read(part)) {
      const auto [known, is_new] = noted.try_emplace(frame, row);
      if (!is_new && known->second != row) known->second = taken_out_of(row);
    }
  for (const auto& [frame, row] : noted) is_taken_out(row) ? void(rows_.erase(frame)) : void(rows_[frame] = row);
  if (!own_.empty()) own_rows_ = read(own_);
}

std::string FrameTable::why_redo(int frame, const Identity& identity) const {
  const auto row = rows_.find(frame);
  if (row == rows_.end()) return "new";
  for (std::size_t i = 0; i < identity.size(); ++i)
    if (i >= row->second.size() || row->second[i] != identity[i])
      return fmt::format("the {} changed", identity[i].first);
  return {};
}

void FrameTable::enter(int frame, const Identity& identity) {
  for (Rows* rows : {&rows_, &own_rows_}) {
    // A table has one header.
    if (!rows->empty() && names_of(rows->begin()->second) != names_of(identity)) rows->clear();
    (*rows)[frame] = identity;
  }
  save();
}

void FrameTable::remove(int frame) {
  const auto row = rows_.find(frame);
  if (row == rows_.end()) return;
  if (!own_rows_.empty() && names_of(own_rows_.begin()->second) != names_of(row->second)) own_rows_.clear();
  own_rows_[frame] = taken_out_of(row->second);
  rows_.erase(row);
  save();
}

std::vector<int> FrameTable::frames() const {
  std::vector<int> list;
  for (const auto& [frame, row] : rows_) list.push_back(frame);
  return list;
}

void FrameTable::save() const { own_.empty() ? write(file_, rows_) : write(own_, own_rows_); }

}  // namespace dreampm
