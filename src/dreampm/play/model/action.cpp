#include "dreampm/play/model/action.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "dreampm/error.h"

namespace dreampm::play {

Action Action::parse(std::string_view line) {
  Action action;
  std::istringstream in{std::string(line)};
  in >> action.verb;
  if (action.verb.starts_with('#')) return {};
  while (in >> std::ws && in.peek() != '#' && !in.eof()) {
    std::string word;
    if (!(in >> std::quoted(word)))
      throw InputError(fmt::format("{}: a word begins with \" and does not end", action.verb));
    action.words.push_back(std::move(word));
  }
  return action;
}

std::string Action::text() const {
  std::ostringstream out;
  out << verb;
  for (const std::string& word : words)
    if (word.empty() || word.find_first_of(" \t\n\v\f\r\"#") != std::string::npos)
      out << ' ' << std::quoted(word);
    else
      out << ' ' << word;
  return out.str();
}

const std::string& Action::word(std::size_t at) const {
  if (at >= words.size()) throw InputError(fmt::format("{}: word {} is missing", verb, at + 1));
  return words[at];
}

double Action::number(std::size_t at) const {
  const std::string& text = word(at);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
    throw InputError(fmt::format("{}: '{}' must be a number", verb, text));
  return value;
}

int Action::whole(std::size_t at, int most) const {
  const double value = number(at);
  if (value != std::floor(value) || value < 0 || value > most)
    throw InputError(fmt::format("{}: '{}' must be a whole number from 0 to {}", verb, word(at), most));
  return static_cast<int>(value);
}

std::string text_of(double number) { return fmt::format("{}", number); }

std::string grouped(std::uint64_t number) {
  std::string text = std::to_string(number);
  for (auto at = static_cast<int>(text.size()) - 3; at > 0; at -= 3) text.insert(static_cast<std::size_t>(at), ",");
  return text;
}

}  // namespace dreampm::play
