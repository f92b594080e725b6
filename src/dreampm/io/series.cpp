#include "dreampm/io/series.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/io/append.h"
#include "dreampm/io/ledger.h"

namespace dreampm {
namespace fs = std::filesystem;
namespace {

std::string line_of(const std::vector<double>& row) {
  std::string text;
  for (const double v : row) {
    if (!text.empty()) text += ',';
    text += exact_text(v);
  }
  return text + '\n';
}

double number_in(const std::string& cell, const std::string& file, std::size_t line) {
  double v{};
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), v);
  if (error != std::errc() || end != cell.data() + cell.size())
    fail_input("{}:{}: \"{}\" is no number", file, line, cell);
  return v;
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  for (const char c : line)
    if (c == ',')
      cells.emplace_back();
    else
      cells.back() += c;
  return cells;
}

}  // namespace

std::vector<double> Series::column(const std::string& name) const {
  const auto at = std::find(columns.begin(), columns.end(), name) - columns.begin();
  if (at == std::ssize(columns)) fail_input("no column {}; there are {}", name, fmt::join(columns, ", "));
  std::vector<double> values;
  for (const auto& row : rows) values.push_back(row[static_cast<std::size_t>(at)]);
  return values;
}

Series read_series(const fs::path& file) {
  const std::string name = file.string(), text = read_file(file);
  Series out;
  std::size_t number = 0;
  for (std::size_t at = 0, end; (end = text.find('\n', at)) != std::string::npos; at = end + 1) {
    ++number;
    const std::vector<std::string> cells = cells_of(text.substr(at, end - at));
    if (number == 1) {
      out.columns = cells;
      if (cells.front() != "time") fail_input("{}: the first column must be \"time\"", name);
      continue;
    }
    if (cells.size() != out.columns.size())
      fail_input("{}:{}: {} values, but there are {} columns", name, number, cells.size(), out.columns.size());
    std::vector<double> row;
    for (const std::string& c : cells) row.push_back(number_in(c, name, number));
    if (!out.rows.empty() && !(row[0] > out.rows.back()[0]))
      fail_input("{}:{}: time {} follows time {}", name, number, row[0], out.rows.back()[0]);
    out.rows.push_back(std::move(row));
  }
  if (number == 0) fail_input("{}: no series: the first line must name the columns", name);
  return out;
}

SeriesWriter::SeriesWriter(fs::path file, std::vector<std::string> columns, std::optional<double> keep_until)
    : file_(std::move(file)), columns_(std::move(columns)) {
  columns_.insert(columns_.begin(), "time");
  std::string text = fmt::format("{}\n", fmt::join(columns_, ","));
  if (keep_until) {
    const Series old = read_series(file_);
    if (old.columns != columns_)
      fail_input("{}: its columns are {}; this run writes {}", file_.string(), fmt::join(old.columns, ","),
                 fmt::join(columns_, ","));
    for (const auto& row : old.rows)
      if (row[0] <= *keep_until) {
        text += line_of(row);
        last_ = row[0];
      }
  }
  replace_file_text(file_, text);
}

void SeriesWriter::append(double time, std::span<const double> values) {
  if (values.size() + 1 != columns_.size())
    fail_input("{}: {} values for {} columns", file_.string(), values.size() + 1, columns_.size());
  if (last_ && !(time > *last_)) fail_input("{}: time {} cannot follow time {}", file_.string(), time, *last_);
  std::vector<double> row{time};
  row.insert(row.end(), values.begin(), values.end());
  append_text(file_, line_of(row));
  last_ = time;
}

}  // namespace dreampm
