// Records are files: whatever a line of one says, it is done, or refused as input.
#include <gtest/gtest.h>

#include <random>

#include "play/small_scene.h"

namespace dreampm::play::any_script_test {
namespace {

using test::quiet_options;
using test::small_scene;

/// Lines of every verb that writes no file and opens no other stage, with numbers and words of any
/// kind in any number.
class AnyLine {
 public:
  explicit AnyLine(unsigned seed) : chance_(seed) {
    for (const Verb& v : verbs())
      if (const std::string_view name = v.name; name != "save" && name != "estimate" && name != "render" &&
                                                name != "film" && name != "open" && name != "size" && name != "compare")
        verbs_.emplace_back(name);
  }
  std::string next(const Frame& frame) {
    std::string line = verbs_[below(verbs_.size())];
    if (line == "set") line += " " + (*frame.controls)[below(frame.controls->size())].id;
    if (line == "wall") line += std::string(" ") + (below(2) ? "x" : "y") + (below(2) ? "_min" : "_max");
    if (line == "drop") line += below(2) ? " crate" : " sphere";
    for (std::size_t n = below(9); n > 0; --n) line += " " + word();
    return line;
  }

 private:
  std::size_t below(std::size_t n) { return chance_() % n; }
  std::string word() {
    static const char* const hostile[] = {"1e300", "-1e300", "1e-300", "1e18", "-3e9", "2147483648", "nan",
                                          "inf",   "off",    "",       "x",    "1e39", "-0",         "65536"};
    if (below(3) == 0) return hostile[below(std::size(hostile))];
    return text_of(static_cast<double>(below(500)) / 1000);  // a place in the tank, or near it
  }
  std::mt19937 chance_;
  std::vector<std::string> verbs_;
};

TEST(AnyScript, WordsOfAnyLettersComeBack) {
  const Action action{"drop", {"", "two words", "a\tb", "a\vb", "\"quoted\"", "#", "back\\slash", "plain"}};
  EXPECT_EQ(Action::parse(action.text()), action);
}

/// Other lines: --gtest_shuffle --gtest_random_seed=N.
TEST(AnyScript, ALineIsDoneOrRefusedAsInput) {
  std::size_t done = 0, refused = 0;
  const auto first = 4 * static_cast<unsigned>(testing::UnitTest::GetInstance()->random_seed());
  for (unsigned seed = first; seed < first + 4; ++seed) {
    Playground playground(small_scene(), quiet_options());
    AnyLine lines(seed);
    for (int n = 0; n < 100; ++n) {
      const std::string line = lines.next(*playground.frame());
      SCOPED_TRACE(line);
      try {
        playground.act(Action::parse(line));
        ++done;
      } catch (const InputError& e) {
        EXPECT_NE(std::string(e.what()), "");
        ++refused;
      }
      playground.tick({2, {}});
    }
  }
  EXPECT_GT(done, 50u);
  EXPECT_GT(refused, 50u);
}

/// Cells and layers without end: a jet of these numbers ended the program, or took minutes a frame.
TEST(AnyScript, WhatIsLargerThanTheBoxOrFarFromItIsRefused) {
  Playground playground(small_scene(), quiet_options());
  for (const char* line : {"pour 0.1 0.1 0.1 1e18 0 0 1", "pour 0.1 0.1 0.1 0.05 1e300 0 0", "pour 1e300 0 0 0.1 0 1 0",
                           "drop sphere 0.1 0.1 0.1 65536", "cut 0.1 0.1 0.1 0 1 0 1e39", "pin 0.1 0.1 0.1 2147483648",
                           "erase 0.1 1e18 0.1 0.1", "grab 0.1 0.1 0.1 1e18"})
    EXPECT_NE(test::refusal(playground, line), "") << line;
  EXPECT_EQ(test::refusal(playground, "pour 0.1 0.3 0.1 0.05 0 -1 0"), "");
}

}  // namespace
}  // namespace dreampm::play::any_script_test
