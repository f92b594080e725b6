// Text files of geometry, line by line: what OFF, OBJ and ASCII STL share.
#pragma once
#include <charconv>
#include <string>
#include <string_view>
#include <vector>

#include "dreampm/base/error.h"

namespace dreampm {

/// Lines end with LF, CRLF or CR; a byte order mark at the start and empty lines are skipped.
class TextLines {
 public:
  /// Reads lines of `text`. The rest of a line after the character `comment` is left out; '\0':
  /// there are no comments. A backslash at the end of a line joins the next one to it if `joined`.
  /// `name` is for messages and must outlive this object.
  TextLines(std::string_view text, const std::string& name, char comment, bool joined = false);

  /// Goes to the next line that has words; false at the end of the text.
  bool next();
  /// The same, where the end is an error: "is cut short: it ends before {what}".
  const std::vector<std::string_view>& need(const char* what);

  const std::vector<std::string_view>& words() const { return words_; }
  /// Number of the line, from 1.
  int line() const { return line_; }

  /// Word `i` as a number. Throws InputError naming file and line.
  template <class T>
  T number(std::size_t i, const char* what) const {
    if (i >= words_.size())
      fail_input("{}:{}: the line is cut short: {} wants more than {} numbers", name_, line_, what, words_.size());
    return number_in<T>(words_[i], what);
  }
  /// A part of a word as a number.
  template <class T>
  T number_in(std::string_view part, const char* what) const {
    std::string_view digits = part;
    if (digits.starts_with('+')) digits.remove_prefix(1);
    T value{};
    const auto [end, ec] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (ec == std::errc::result_out_of_range && (digits.find("e-") != digits.npos || digits.find("E-") != digits.npos))
      return T{};  // smaller than any number but 0
    if (ec != std::errc() || end != digits.data() + digits.size())
      fail_input("{}:{}: {} that is right is wanted, not \"{}\"", name_, line_, what, shown(part));
    return value;
  }

 private:
  static std::string shown(std::string_view word);
  std::string_view take_line();
  std::string_view text_;
  const std::string& name_;
  char comment_;
  bool joined_;
  std::size_t at_ = 0;
  int line_ = 0;
  std::vector<std::string_view> words_;
};

/// Returns the text in lower case, as keywords are compared.
std::string lower(std::string_view text);

}  // namespace dreampm
