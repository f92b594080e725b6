#include "dreampm/io/ledger.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <type_traits>

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

std::vector<std::string> names_of(const std::vector<LedgerCell>& cells) {
  std::vector<std::string> names;
  for (const LedgerCell& cell : cells) names.push_back(cell.name());
  return names;
}

std::string cell_text(const LedgerRow& row, const LedgerCell& cell) {
  return std::visit(
      [&]<class M>(M LedgerRow::* member) -> std::string {
        if constexpr (std::is_same_v<M, int>) return std::to_string(row.*member);
        if constexpr (std::is_same_v<M, Limiter>) return std::string(name_of(row.*member));
        if constexpr (std::is_same_v<M, double>) return exact_text(row.*member);
        if constexpr (std::is_same_v<M, Vec3d>) return exact_text((row.*member)[cell.axis]);
      },
      cell.column->value);
}

std::string row_text(const std::vector<LedgerCell>& cells, const LedgerRow& row) {
  std::vector<std::string> words;
  for (const LedgerCell& cell : cells) words.push_back(cell_text(row, cell));
  return join(words);
}

/// The cells that the first line of a file names.
std::vector<LedgerCell> cells_of(const std::string& file, const std::vector<std::string>& columns) {
  if (columns.empty() || columns.front() != "frame") fail_input("{}: the first column must be \"frame\"", file);
  std::vector<LedgerCell> cells;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto here = columns.begin() + static_cast<std::ptrdiff_t>(i);
    if (std::find(columns.begin(), here, *here) != here) fail_input("{}: column {} is there twice", file, *here);
    cells.push_back(find_ledger_cell(*here));
    if (!cells.back().column) fail_input("{}: \"{}\" is no column of a ledger", file, *here);
  }
  return cells;
}

template <class T>
T parse(const std::string& file, std::size_t line, const std::string& column, const std::string& text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    fail_input("{}:{}: \"{}\" in column {} is no number", file, line, text, column);
  return value;
}

constexpr Limiter all_limiters[] = {Limiter::speed, Limiter::wave, Limiter::viscosity, Limiter::frame, Limiter::user};

Limiter parse_limiter(const std::string& file, std::size_t line, const std::string& text) {
  for (const Limiter limiter : all_limiters)
    if (name_of(limiter) == text) return limiter;
  std::vector<std::string_view> names;
  for (const Limiter limiter : all_limiters) names.push_back(name_of(limiter));
  fail_input("{}:{}: limiter \"{}\" is not one of {}", file, line, text, fmt::join(names, ", "));
}

void parse_cell(const std::string& file, std::size_t line, const LedgerCell& cell, const std::string& text,
                LedgerRow& row) {
  std::visit(
      [&]<class M>(M LedgerRow::* member) {
        if constexpr (std::is_same_v<M, Limiter>)
          row.*member = parse_limiter(file, line, text);
        else if constexpr (std::is_same_v<M, Vec3d>)
          (row.*member)[cell.axis] = parse<double>(file, line, cell.name(), text);
        else
          row.*member = parse<M>(file, line, cell.name(), text);
      },
      cell.column->value);
}

}  // namespace

std::string exact_text(double value) { return std::isnan(value) ? "nan" : fmt::format("{}", value); }

LedgerWriter::LedgerWriter(fs::path file, const LedgerKind& kind, int keep_until)
    : file_(std::move(file)), cells_(ledger_cells(kind)) {
  const std::vector<std::string> columns = names_of(cells_);
  std::string text = join(columns);
  if (keep_until > 0) {
    const Ledger old = read_ledger(file_);
    if (old.columns != columns)
      fail_input("{}: its columns are {}; this run writes {}", file_.string(), fmt::join(old.columns, ","),
                 fmt::join(columns, ","));
    for (const LedgerRow& row : old.rows)
      if (row.frame <= keep_until) {
        text += row_text(cells_, row);
        last_frame_ = row.frame;
      }
  }
  replace_file_text(file_, text);
}

void LedgerWriter::append(const LedgerRow& row) {
  if (row.frame <= last_frame_)
    fail_input("{}: frame {} cannot follow frame {}", file_.string(), row.frame, last_frame_);
  append_text(file_, row_text(cells_, row));
  last_frame_ = row.frame;
}

Ledger read_ledger(const fs::path& file) {
  const std::string name = file.string(), text = read_file(file);
  Ledger out;
  std::vector<LedgerCell> columns;
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
      columns = cells_of(name, out.columns);
      continue;
    }
    if (cells.size() != out.columns.size())
      fail_input("{}:{}: {} values, but there are {} columns", name, number, cells.size(), out.columns.size());
    LedgerRow row;
    for (std::size_t i = 0; i < cells.size(); ++i) parse_cell(name, number, columns[i], cells[i], row);
    if (!out.rows.empty() && row.frame <= out.rows.back().frame)
      fail_input("{}:{}: frame {} follows frame {}", name, number, row.frame, out.rows.back().frame);
    out.rows.push_back(std::move(row));
  }
  if (number == 0) fail_input("{}: no ledger: the first line must name the columns", name);
  return out;
}

}  // namespace dreampm
