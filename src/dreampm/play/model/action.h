// One thing that is done in the playground: a line of a script.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace dreampm::play {

/// A verb and its words: "set gravity.y -3".
struct Action {
  std::string verb;
  std::vector<std::string> words;

  /// The words of a line, between blanks; "#" begins a comment. Without words the verb is empty.
  static Action parse(std::string_view line);
  std::string text() const;
  /// The number at that place of the words. Throws InputError where there is none.
  double number(std::size_t at) const;
  /// The whole number at that place, from 0 to `most`. Throws InputError where there is none.
  int whole(std::size_t at, int most) const;
  /// Throws InputError where there is none.
  const std::string& word(std::size_t at) const;

  bool operator==(const Action&) const = default;
};

/// A number as text that reads back as the same bits.
std::string text_of(double number);

/// With a comma after each three digits from the right.
std::string grouped(std::uint64_t number);

}  // namespace dreampm::play
