#include "dreampm/io/ledger.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/io/append.h"

namespace dreampm {
namespace fs = std::filesystem;
namespace {

std::vector<std::string> split(std::string_view line) {
  std::vector<std::string> out;
  for (std::size_t at = 0;;) {
    const std::size_t end = line.find(',', at);
    out.emplace_back(line.substr(at, end == std::string_view::npos ? end : end - at));
    if (end == std::string_view::npos) return out;
    at = end + 1;
  }
}

std::string join(const std::vector<std::string>& words) { return fmt::format("{}\n", fmt::join(words, ",")); }

// What may limit a step.
const std::vector<std::string>& limiters() {
  static const std::vector<std::string> names = {"speed", "wave", "viscosity", "frame", "user"};
  return names;
}

void check_columns(const std::string& file, const std::vector<std::string>& columns) {
  if (columns.empty() || columns.front() != "frame") fail_input("{}: the first column must be \"frame\"", file);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i].empty() || columns[i].find_first_of(",\r\n\"") != std::string::npos)
      fail_input("{}: \"{}\" cannot name a column", file, columns[i]);
    if (std::find(columns.begin(), columns.begin() + static_cast<std::ptrdiff_t>(i), columns[i]) !=
        columns.begin() + static_cast<std::ptrdiff_t>(i))
      fail_input("{}: column {} is there twice", file, columns[i]);
  }
}

std::string row_text(const std::string& file, const std::vector<std::string>& columns, const LedgerRow& row) {
  std::vector<std::string> cells;
  std::size_t used = 0;
  for (const std::string& name : columns) {
    if (name == "frame") {
      cells.push_back(std::to_string(row.frame));
    } else if (name == "limiter") {
      if (std::find(limiters().begin(), limiters().end(), row.limiter) == limiters().end())
        fail_input("{}: frame {}: limiter \"{}\" is not one of {}", file, row.frame, row.limiter,
                   fmt::join(limiters(), ", "));
      cells.push_back(row.limiter);
    } else {
      const auto value = row.values.find(name);
      if (value == row.values.end()) fail_input("{}: frame {}: no value for column {}", file, row.frame, name);
      cells.push_back(exact_text(value->second));
      ++used;
    }
  }
  if (used != row.values.size())
    for (const auto& [name, value] : row.values)
      if (std::find(columns.begin(), columns.end(), name) == columns.end())
        fail_input("{}: frame {}: the ledger has no column {}", file, row.frame, name);
  return join(cells);
}

template <class T>
T parse(const std::string& file, std::size_t line, const std::string& column, const std::string& text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    fail_input("{}:{}: \"{}\" in column {} is no number", file, line, text, column);
  return value;
}

}  // namespace

const std::vector<std::string>& ledger_columns() {
  static const std::vector<std::string> names = {"frame",
                                                 "time",
                                                 "substeps",
                                                 "dt_min",
                                                 "dt_max",
                                                 "limiter",
                                                 "stages",
                                                 "particles",
                                                 "left",
                                                 "mass",
                                                 "left_mass",
                                                 "grid_mass",
                                                 "momentum_x",
                                                 "momentum_y",
                                                 "momentum_z",
                                                 "angular_x",
                                                 "angular_y",
                                                 "angular_z",
                                                 "kinetic",
                                                 "elastic",
                                                 "gravity",
                                                 "work",
                                                 "power",
                                                 "dissipated",
                                                 "dissipated_viscosity",
                                                 "dissipated_plasticity",
                                                 "dissipated_relaxation",
                                                 "dissipated_friction",
                                                 "dissipated_transfer",
                                                 "dissipated_damping",
                                                 "dissipated_rest",
                                                 "wall_impulse_x",
                                                 "wall_impulse_y",
                                                 "wall_impulse_z",
                                                 "wall_angular_x",
                                                 "wall_angular_y",
                                                 "wall_angular_z",
                                                 "body_impulse_x",
                                                 "body_impulse_y",
                                                 "body_impulse_z",
                                                 "body_angular_x",
                                                 "body_angular_y",
                                                 "body_angular_z",
                                                 "left_momentum_x",
                                                 "left_momentum_y",
                                                 "left_momentum_z",
                                                 "left_angular_x",
                                                 "left_angular_y",
                                                 "left_angular_z",
                                                 "momentum_bound",
                                                 "angular_bound",
                                                 "energy_bound",
                                                 "volume",
                                                 "j_min",
                                                 "j_max",
                                                 "swollen"};
  return names;
}

const std::vector<std::string>& inflow_columns() {
  static const std::vector<std::string> names = {"entered",
                                                 "entered_mass",
                                                 "entered_energy",
                                                 "entered_momentum_x",
                                                 "entered_momentum_y",
                                                 "entered_momentum_z",
                                                 "entered_angular_x",
                                                 "entered_angular_y",
                                                 "entered_angular_z"};
  return names;
}

const std::vector<std::string>& projection_columns() {
  static const std::vector<std::string> names = {"dissipated_projection"};
  return names;
}

std::string exact_text(double value) { return std::isnan(value) ? "nan" : fmt::format("{}", value); }

LedgerWriter::LedgerWriter(fs::path file, std::vector<std::string> columns, int keep_until)
    : file_(std::move(file)), columns_(std::move(columns)) {
  check_columns(file_.string(), columns_);
  std::string text = join(columns_);
  if (keep_until > 0) {
    const Ledger old = read_ledger(file_);
    if (old.columns != columns_)
      fail_input("{}: its columns are {}; this run writes {}", file_.string(), fmt::join(old.columns, ","),
                 fmt::join(columns_, ","));
    for (const LedgerRow& row : old.rows)
      if (row.frame <= keep_until) {
        text += row_text(file_.string(), columns_, row);
        last_frame_ = row.frame;
      }
  }
  replace_file_text(file_, text);
}

void LedgerWriter::append(const LedgerRow& row) {
  const std::string name = file_.string();
  if (row.frame <= last_frame_) fail_input("{}: frame {} cannot follow frame {}", name, row.frame, last_frame_);
  const std::string text = row_text(name, columns_, row);
  append_text(file_, text);
  last_frame_ = row.frame;
}

Ledger read_ledger(const fs::path& file) {
  const std::string name = file.string(), text = read_file(file);
  Ledger out;
  std::size_t number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    if (end == std::string::npos) break;  // a killed run's half row
    std::string line = text.substr(at, end - at);
    if (!line.empty() && line.back() == '\r') line.pop_back();
    at = end + 1;
    ++number;
    const std::vector<std::string> cells = split(line);
    if (number == 1) {
      out.columns = cells;
      check_columns(name, out.columns);
      continue;
    }
    if (cells.size() != out.columns.size())
      fail_input("{}:{}: {} values, but there are {} columns", name, number, cells.size(), out.columns.size());
    LedgerRow row;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (out.columns[i] == "frame")
        row.frame = parse<int>(name, number, "frame", cells[i]);
      else if (out.columns[i] == "limiter")
        row.limiter = cells[i];
      else
        row.values[out.columns[i]] = parse<double>(name, number, out.columns[i], cells[i]);
    }
    if (!out.rows.empty() && row.frame <= out.rows.back().frame)
      fail_input("{}:{}: frame {} follows frame {}", name, number, row.frame, out.rows.back().frame);
    out.rows.push_back(std::move(row));
  }
  if (number == 0) fail_input("{}: no ledger: the first line must name the columns", name);
  return out;
}

}  // namespace dreampm
