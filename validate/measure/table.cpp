#include "validate/measure/table.h"

#include <algorithm>
#include <cstdlib>

#include "dreampm/base/error.h"

namespace dreampm::validate {
namespace {

std::vector<std::string> split(std::string_view line) {
  std::vector<std::string> words(1);
  for (const char c : line)
    if (c == ',')
      words.emplace_back();
    else if (c != '\r')
      words.back() += c;
  return words;
}

}  // namespace

Table::Table(std::string_view text, std::string name) : name_(std::move(name)) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.empty() || line[0] == '#') continue;
    std::vector<std::string> words = split(line);
    if (columns_.empty()) {
      columns_ = std::move(words);
      continue;
    }
    // A note at the end of a row may hold commas.
    if (words.size() < columns_.size())
      fail_input("{}: a row of {} cells, the head has {}: {}", name_, words.size(), columns_.size(), line);
    for (std::size_t i = columns_.size(); i < words.size(); ++i) words[columns_.size() - 1] += "," + words[i];
    words.resize(columns_.size());
    rows_.push_back(std::move(words));
  }
}

std::size_t Table::at(std::string_view column) const {
  const auto it = std::find(columns_.begin(), columns_.end(), column);
  if (it == columns_.end()) fail_input("{}: there is no column {}", name_, column);
  return static_cast<std::size_t>(it - columns_.begin());
}

const std::string& Table::text(std::size_t row, std::string_view column) const { return rows_.at(row)[at(column)]; }

double Table::number(std::size_t row, std::string_view column) const {
  const std::string& word = text(row, column);
  char* end = nullptr;
  const double value = std::strtod(word.c_str(), &end);
  if (word.empty() || *end) fail_input("{}: row {}, {}: '{}' is no number", name_, row + 1, column, word);
  return value;
}

std::vector<double> Table::numbers(std::string_view column) const {
  std::vector<double> all;
  for (std::size_t r = 0; r < size(); ++r) all.push_back(number(r, column));
  return all;
}

Table Table::where(std::string_view column, std::string_view value) const {
  const std::size_t c = at(column);
  Table some;
  some.name_ = name_, some.columns_ = columns_;
  for (const auto& row : rows_)
    if (row[c] == value) some.rows_.push_back(row);
  return some;
}

}  // namespace dreampm::validate
