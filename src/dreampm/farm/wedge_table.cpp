#include "dreampm/farm/wedge_table.h"

#include <algorithm>
#include <array>
#include <map>
#include <sstream>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/base/progress.h"
#include "dreampm/io/ledger.h"
#include "dreampm/io/run_record.h"

namespace dreampm::farm {
namespace fs = std::filesystem;
namespace {

/// A cell as RFC 4180 has it.
std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

/// Nothing for a line whose quotes do not close.
std::optional<std::vector<std::string>> csv_cells(const std::string& line) {
  std::vector<std::string> cells{""};
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"')
      cells.back() += line[++i];
    else if (line[i] == '"')
      quoted = !quoted;
    else if (line[i] == ',' && !quoted)
      cells.emplace_back();
    else
      cells.back() += line[i];
  }
  if (quoted) return std::nullopt;
  return cells;
}

/// Of probes/NAME.csv: its columns after the time, with what its last whole line has.
void add_probe(const fs::path& file, const std::string& name, WedgeRow& row) {
  if (!fs::exists(file)) return;
  const std::string text = read_file(file);
  std::istringstream lines(text.substr(0, text.rfind('\n') + 1));
  std::string line, last;
  if (!std::getline(lines, line)) return;
  const auto head = csv_cells(line);
  while (std::getline(lines, line)) last = line;
  const auto values = csv_cells(last);
  if (!head || !values || values->size() != head->size()) return;
  for (std::size_t c = 1; c < head->size(); ++c) row.probes.emplace_back(name + "." + (*head)[c], (*values)[c]);
}

/// Taken over rest volume of all meshed materials in a frame.
double swollen_at(const std::vector<VolumeRecord>& volumes, int frame) {
  double taken = 0, rest = 0;
  for (const VolumeRecord& v : volumes)
    if (v.frame == frame && v.taken) taken += *v.taken, rest += v.particles;
  return rest > 0 ? taken / rest : 0;
}

std::optional<double> volume_kept(const RunRecord& record) {
  const auto stage = record.stages.find("surface");
  if (stage == record.stages.end() || stage->second.volumes.empty()) return std::nullopt;
  const auto& volumes = stage->second.volumes;
  const double first = swollen_at(volumes, volumes.front().frame), last = swollen_at(volumes, volumes.back().frame);
  return first > 0 && last > 0 ? std::optional<double>(last / first) : std::nullopt;
}

void add_ledger(const fs::path& file, WedgeRow& row) {
  if (!fs::exists(file)) return;
  for (const LedgerRow& r : read_ledger(file).rows)
    if (r.dt_min > 0) row.dt_min = std::min(row.dt_min.value_or(r.dt_min), r.dt_min);
}

template <class T>
std::string text_or_nothing(const std::optional<T>& value, const auto& text) {
  return value ? text(*value) : std::string();
}

/// What stands between status and probes, in the order of the file.
struct Column {
  const char* name;
  const char* on_screen;
  std::string (*exact)(const WedgeRow&);
  std::string (*brief)(const WedgeRow&);
};
constexpr auto count_text = [](std::uint64_t n) { return std::to_string(n); };
std::string percent(double x) { return fmt::format("{:.2f} %", 100 * x); }
std::string few_digits(double x) { return fmt::format("{:.3g}", x); }

constexpr std::array<Column, 7> measured{{
    {"frames", "frames", [](const WedgeRow& r) { return std::to_string(r.frames); },
     [](const WedgeRow& r) { return std::to_string(r.frames); }},
    {"particles", "particles", [](const WedgeRow& r) { return text_or_nothing(r.particles, count_text); },
     [](const WedgeRow& r) { return text_or_nothing(r.particles, count_text); }},
    {"volume_kept", "volume", [](const WedgeRow& r) { return text_or_nothing(r.volume_kept, exact_text); },
     [](const WedgeRow& r) { return text_or_nothing(r.volume_kept, percent); }},
    {"dt_min", "dt [s]", [](const WedgeRow& r) { return text_or_nothing(r.dt_min, exact_text); },
     [](const WedgeRow& r) { return text_or_nothing(r.dt_min, few_digits); }},
    {"substeps", "steps", [](const WedgeRow& r) { return text_or_nothing(r.substeps, count_text); },
     [](const WedgeRow& r) { return text_or_nothing(r.substeps, count_text); }},
    {"seconds", "cost", [](const WedgeRow& r) { return text_or_nothing(r.seconds, exact_text); },
     [](const WedgeRow& r) { return text_or_nothing(r.seconds, duration_text); }},
    {"state_hash", "hash", [](const WedgeRow& r) { return r.state_hash; },
     [](const WedgeRow& r) { return r.state_hash.substr(0, 8); }},
}};

/// Names of all probes' columns, in the order of the runs.
std::vector<std::string> probe_columns(const std::vector<WedgeRow>& rows) {
  std::vector<std::string> names;
  for (const WedgeRow& row : rows)
    for (const auto& [name, value] : row.probes)
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  return names;
}

std::string probe_value(const WedgeRow& row, const std::string& name) {
  for (const auto& [probe, value] : row.probes)
    if (probe == name) return value;
  return {};
}

std::string brief_number(const std::string& text) {
  double value = 0;
  std::istringstream in(text);
  return in >> value ? fmt::format("{:.5g}", value) : text;
}

std::string csv_line(const std::vector<std::string>& cells) {
  std::string line;
  for (std::size_t c = 0; c < cells.size(); ++c) line += (c > 0 ? "," : "") + csv_cell(cells[c]);
  return line + "\n";
}

/// In columns as wide as their widest cell.
std::string aligned(const std::vector<std::vector<std::string>>& lines) {
  std::vector<std::size_t> widths(lines[0].size());
  for (const auto& line : lines)
    for (std::size_t c = 0; c < line.size(); ++c) widths[c] = std::max(widths[c], line[c].size());
  std::string text;
  for (const auto& line : lines) {
    std::string one;
    for (std::size_t c = 0; c < line.size(); ++c) one += fmt::format("{:<{}}  ", line[c], widths[c]);
    text += one.substr(0, one.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

}  // namespace

WedgeRow measure_run(const fs::path& folder) {
  WedgeRow row;
  if (!fs::exists(folder / "run.json")) return row;
  const RunRecord record = RunRecord::load(folder / "run.json");
  row.status = record.status;
  row.frames = record.frames.size();
  row.particles = record.particles;
  row.volume_kept = volume_kept(record);
  std::uint64_t substeps = 0;
  for (const FrameRecord& f : record.frames) substeps += f.substeps;
  row.substeps = substeps;
  if (!record.frames.empty()) row.state_hash = record.frames.back().state_hash;
  for (const auto& [name, stage] : record.stages)
    if (stage.seconds) row.seconds = row.seconds.value_or(0) + *stage.seconds;
  add_ledger(folder / "ledger.csv", row);
  for (const auto& [name, type] : record.probes) add_probe(folder / "probes" / (name + ".csv"), name, row);
  // The simulation may be whole where the film is not.
  const auto film = record.stages.find("video");
  if (row.status == "complete" && (film == record.stages.end() || film->second.status != "complete"))
    row.status = "interrupted";
  return row;
}

std::vector<WedgeRow> measure_wedge(const Wedge& wedge, const fs::path& folder) {
  std::vector<WedgeRow> rows;
  for (const WedgeRun& run : wedge.runs) rows.push_back(measure_run(folder / run.name));
  return rows;
}

std::string csv_text(const Wedge& wedge, const std::vector<WedgeRow>& rows) {
  const std::vector<std::string> probes = probe_columns(rows);
  std::vector<std::string> head{"folder"};
  head.insert(head.end(), wedge.keys.begin(), wedge.keys.end());
  head.emplace_back("status");
  for (const Column& c : measured) head.emplace_back(c.name);
  head.insert(head.end(), probes.begin(), probes.end());
  std::string text = csv_line(head);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    std::vector<std::string> cells{wedge.runs[r].name};
    cells.insert(cells.end(), wedge.runs[r].values.begin(), wedge.runs[r].values.end());
    cells.push_back(rows[r].status);
    for (const Column& c : measured) cells.push_back(c.exact(rows[r]));
    for (const std::string& p : probes) cells.push_back(probe_value(rows[r], p));
    text += csv_line(cells);
  }
  return text;
}

Wedge read_wedge(const fs::path& file) {
  std::istringstream lines(read_file(file));
  std::string line;
  std::getline(lines, line);
  const auto head = csv_cells(line);
  const auto status =
      head ? std::find(head->begin(), head->end(), "status") : std::vector<std::string>::const_iterator();
  if (!head || head->at(0) != "folder" || status == head->end())
    fail_input("{}:1: is no table of a wedge: 'folder', keys and 'status' come first", file.string());
  Wedge wedge;
  wedge.keys.assign(head->begin() + 1, status);
  for (int number = 2; std::getline(lines, line); ++number) {
    const auto cells = csv_cells(line);
    if (!cells || cells->size() != head->size())
      fail_input("{}:{}: {} cells; its first line has {}", file.string(), number, cells ? cells->size() : 0,
                 head->size());
    const fs::path name = cells->at(0);
    if (name.empty() || name.has_parent_path() || name == "..")
      fail_input("{}:{}: '{}' is no folder of a run", file.string(), number, cells->at(0));
    wedge.runs.push_back(
        {name, {cells->begin() + 1, cells->begin() + 1 + static_cast<std::ptrdiff_t>(wedge.keys.size())}});
  }
  return wedge;
}

std::string screen_text(const Wedge& wedge, const std::vector<WedgeRow>& rows) {
  const std::vector<std::string> probes = probe_columns(rows);
  std::vector<std::vector<std::string>> lines(1, wedge.keys);
  lines[0].emplace_back("status");
  for (const Column& c : measured) lines[0].emplace_back(c.on_screen);
  lines[0].insert(lines[0].end(), probes.begin(), probes.end());
  for (std::size_t r = 0; r < rows.size(); ++r) {
    std::vector<std::string>& cells = lines.emplace_back(wedge.runs[r].values);
    cells.push_back(rows[r].status);
    for (const Column& c : measured) cells.push_back(c.brief(rows[r]));
    for (const std::string& p : probes) cells.push_back(brief_number(probe_value(rows[r], p)));
  }
  return aligned(lines);
}

std::vector<std::string> measured_words(const WedgeRow& row) {
  std::vector<std::string> words;
  if (row.status != "complete") words.push_back(row.status);
  if (row.volume_kept) words.push_back("volume " + percent(*row.volume_kept));
  if (row.dt_min) words.push_back("dt " + few_digits(*row.dt_min) + " s");
  if (row.seconds) words.push_back("cost " + duration_text(*row.seconds));
  if (!row.state_hash.empty()) words.push_back("hash " + row.state_hash.substr(0, 8));
  for (const auto& [name, value] : row.probes) words.push_back(name + " " + brief_number(value));
  return words;
}

}  // namespace dreampm::farm
