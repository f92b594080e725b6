#include "dreampm/scene/problem.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace dreampm::scene {

std::string Problem::text() const {
  const char* kind = warning ? "warning" : "error";
  return line > 0 ? fmt::format("{}:{}:{}: {}: {}", file, line, column, kind, message)
                  : fmt::format("{}: {}: {}", file, kind, message);
}

void Problems::add(const Place& at, std::string message, bool warning) {
  Problem p{at.file, at.line, at.column, std::move(message), warning};
  // A value behind a YAML alias is read once for each use.
  if (full() || std::find(list_.begin(), list_.end(), p) != list_.end()) return;
  if (list_.size() == most)
    p = {at.file, 0, 0, fmt::format("more than {} problems; the first are listed", most), false};
  if (!p.warning) ++errors_;
  list_.push_back(std::move(p));
}

int edit_distance(std::string_view a, std::string_view b) {
  std::vector<int> before, last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = int(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = int(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int change = a[i - 1] == b[j - 1] ? 0 : 1;
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + change});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before = last;
    last = row;
  }
  return last[b.size()];
}

std::string suggest(std::string_view word, std::span<const std::string> words) {
  constexpr std::size_t longest = 100;  // of a word that may be one of them
  const std::string* best = nullptr;
  int least = 0;
  for (const std::string& w : words) {
    if (word.size() > longest) break;
    const int d = edit_distance(word, w);
    if (!best || d < least) best = &w, least = d;
  }
  if (words.empty()) return {};
  if (best && least <= std::max<int>(1, int(std::max(word.size(), best->size())) / 3))
    return fmt::format("; did you mean '{}'?", *best);
  return fmt::format("; known: {}", fmt::join(words, ", "));
}

}  // namespace dreampm::scene
