#include "dreampm/import/text_lines.h"

#include <algorithm>

namespace dreampm {

TextLines::TextLines(std::string_view text, const std::string& name, char comment, bool joined)
    : text_(text), name_(name), comment_(comment), joined_(joined) {
  if (text.starts_with("\xef\xbb\xbf")) at_ = 3;
}

std::string_view TextLines::take_line() {
  const std::size_t end = std::min(text_.find_first_of("\r\n", at_), text_.size());
  const std::string_view line = text_.substr(at_, end - at_);
  at_ = end + (text_.substr(std::min(end, text_.size())).starts_with("\r\n") ? 2 : 1);
  ++line_;
  return line;
}

bool TextLines::next() {
  words_.clear();
  while (words_.empty() && at_ < text_.size())
    for (bool more = true; more && at_ < text_.size();) {
      std::string_view line = take_line();
      if (comment_ != '\0') line = line.substr(0, line.find(comment_));
      more = joined_ && line.ends_with('\\');
      if (more) line.remove_suffix(1);
      constexpr std::string_view blanks = " \t\v\f";
      for (std::size_t i = line.find_first_not_of(blanks); i < line.size(); i = line.find_first_not_of(blanks, i)) {
        const std::size_t end = std::min(line.find_first_of(blanks, i), line.size());
        words_.push_back(line.substr(i, end - i));
        i = end;
      }
    }
  return !words_.empty();
}

const std::vector<std::string_view>& TextLines::need(const char* what) {
  if (!next()) fail_input("{}: is cut short: it ends before {}", name_, what);
  return words_;
}

std::string TextLines::shown(std::string_view word) {
  std::string text;
  for (const char c : word.substr(0, 30)) text += c >= ' ' && c <= '~' ? c : '?';
  return text;
}

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : static_cast<char>(c);
  });
  return out;
}

}  // namespace dreampm
