// The faults of a scene, with their places in the file.
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace dreampm::scene {

/// The place of a value in text: 1-based. Line 0: the file as a whole. A value given on the command
/// line has `file` = "--set PATH=VALUE" and line 0.
struct Place {
  std::string file;
  int line = 0, column = 0;
};

struct Problem {
  std::string file;
  int line = 0, column = 0;
  std::string message;
  bool warning = false;

  /// "file:line:col: error: message"
  std::string text() const;
  friend bool operator==(const Problem&, const Problem&) = default;
};

/// Collects problems; nothing is thrown for what a user did.
class Problems {
 public:
  static constexpr std::size_t most = 1000;  ///< those after them are not listed

  void error(const Place& at, std::string message) { add(at, std::move(message), false); }
  void warning(const Place& at, std::string message) { add(at, std::move(message), true); }
  int errors() const { return errors_; }
  /// True if no more is listed, and words for more need not be found.
  bool full() const { return list_.size() > most; }
  const std::vector<Problem>& list() const { return list_; }

 private:
  void add(const Place& at, std::string message, bool warning);
  std::vector<Problem> list_;
  int errors_ = 0;
};

/// Edits between two words: insert, delete, replace, swap neighbors (optimal string alignment).
int edit_distance(std::string_view a, std::string_view b);

/// "; did you mean 'x'?" if one of the words is near, else "; known: a, b, c" (empty if there are
/// none).
std::string suggest(std::string_view word, std::span<const std::string> words);

}  // namespace dreampm::scene
