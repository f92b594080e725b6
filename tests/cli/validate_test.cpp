// `dreampm validate` as a user types it: cases by name, what is refused before anything runs, a run
// that is stopped.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "typed.h"

namespace dreampm::test {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

class ValidateVerb : public Typing {
 protected:
  /// `dreampm validate LINE` is refused before anything ran or was written.
  std::string refused(const std::string& line) const {
    const Typed t = type("validate " + line);
    EXPECT_EQ(t.code, 2) << line << "\n" << t.err;
    EXPECT_EQ(t.out, "") << line;
    EXPECT_FALSE(fs::exists(folder / "out")) << line;
    return t.err;
  }
};

TEST_F(ValidateVerb, ListsItsCases) {
  const Typed t = type("validate --list");
  EXPECT_EQ(t.code, 0) << t.err;
  EXPECT_THAT(t.out, testing::StartsWith("free-fall "));
  EXPECT_THAT(t.out, HasSubstr("\nlong-slosh "));
  EXPECT_THAT(t.out, HasSubstr("(only with --full)\n"));
}

TEST_F(ValidateVerb, ACaseThatPassesExitsWithNothing) {
  Typed t = type("validate snow-press free-fall --markdown page.md");
  ASSERT_EQ(t.code, 0) << t.err;
  EXPECT_THAT(t.out, testing::StartsWith("snow-press: "));
  EXPECT_THAT(t.out, HasSubstr("\n2 of 2 cases passed, 0 missed only gates that they are known to miss, 0 failed; "));
  EXPECT_TRUE(fs::exists(folder / "out/validation/snow-press.svg"));
  const std::string page = read_file(folder / "page.md");
  EXPECT_THAT(page, HasSubstr("\n## snow-press\n"));
  EXPECT_THAT(page, HasSubstr("(out/validation/snow-press.svg)"));
  EXPECT_FALSE(fs::exists(folder / "page.md.part"));

  t = type("validate snow-press --json --out plots");
  ASSERT_EQ(t.code, 0) << t.err;
  const json all = json::parse(t.out);
  EXPECT_EQ(all.at("passed"), 1);
  ASSERT_EQ(all.at("cases").size(), 1u);
  const json& c = all.at("cases")[0];
  EXPECT_EQ(c.at("name"), "snow-press");
  EXPECT_EQ(c.at("pass"), true);
  EXPECT_EQ(c.at("control").at("fails"), true);
  EXPECT_TRUE(fs::exists(folder / c.at("plot").get<std::string>()));
}

TEST_F(ValidateVerb, WhatCannotBeWrittenIsToldBeforeAnythingRuns) {
  EXPECT_EQ(refused("free-fall --out plots --markdown nowhere/page.md"),
            "error: nowhere/page.md: cannot be written: there is no folder nowhere; make it, or name another file\n");
  EXPECT_THAT(refused("free-fall --out plots --markdown plots"), HasSubstr("plots: is a folder; name a file"));
  write("notes", "a file");
  EXPECT_THAT(refused("free-fall --out notes"), HasSubstr("notes: cannot make this folder"));
  EXPECT_THAT(refused("free-fall --out /proc"), HasSubstr("/proc/free-fall.svg: cannot be written"));
  EXPECT_TRUE(fs::is_empty(folder / "plots"));
}

TEST_F(ValidateVerb, CasesThatAreNone) {
  EXPECT_EQ(refused("free-fal"), "error: no case 'free-fal'; did you mean 'free-fall'?\n");
  EXPECT_THAT(refused("weather"), HasSubstr("no case 'weather'; known: free-fall, slopes, "));
  EXPECT_THAT(refused("free-fall all"), HasSubstr("'all' stands alone"));
  EXPECT_THAT(refused("free-fall slopes free-fall"), HasSubstr("case 'free-fall' is named twice"));
  EXPECT_THAT(refused("--list --json"), HasSubstr("excludes"));
}

TEST_F(ValidateVerb, OptionsOfTheCaseStabilityAreOfNoOther) {
  for (const std::string option : {"--draws 5", "--draw 0", "--seed 1"})
    EXPECT_THAT(refused("free-fall " + option),
                HasSubstr(option.substr(0, option.find(' ')) + " is of the case stability, which is not among"));
  EXPECT_THAT(refused("stability --draw 1 --draws 3"), HasSubstr("--draws excludes --draw"));
  const Typed t = type("validate stability --draw 0 --seed 18446744073709551615");
  EXPECT_NE(t.code, 2) << t.err;
  EXPECT_THAT(t.out, HasSubstr("draws of seed 18446744073709551615 that failed, of 1 "));
}

TEST_F(ValidateVerb, ASeedIsAWholeNumberAndNeverWrapped) {
  for (const char* seed : {"-1", "18446744073709551616", "12345678901234567890123", "0x10", "1.5", "one"})
    EXPECT_THAT(refused(std::string("stability --seed ") + seed),
                HasSubstr(std::string("--seed: ") + seed + " is no whole number from 0 to 18446744073709551615"));
  EXPECT_THAT(refused("stability --draws 0"), HasSubstr("0 is no whole number from 1 to 1000000"));
}

TEST_F(ValidateVerb, ARunThatIsStoppedTellsWhatWasDone) {
  // The folder is made once signals are caught. The snow is pressed in a second on any machine; the
  // tanks take minutes.
  const auto stop_after = [&](const std::string& file, const std::string& cases) {
    return shell(std::string("'") + DM_COMMAND + "' validate " + cases +
                 " --out plots & p=$!; while kill -0 $p && ! [ -e " + file +
                 " ]; do sleep 0.05; done; kill -TERM $p; wait $p");
  };
  Typed t = stop_after("plots", "violent-tank long-slosh --threads 2");
  EXPECT_EQ(t.code, 130);
  EXPECT_EQ(t.out, "");
  EXPECT_EQ(t.err, "interrupted: 0 of 2 cases were done\n");
  fs::remove_all(folder / "plots");
  t = stop_after("plots/snow-press.svg", "violent-tank snow-press --threads 2");
  EXPECT_EQ(t.code, 130);
  EXPECT_THAT(t.out, testing::StartsWith("snow-press: "));
  EXPECT_THAT(t.out, HasSubstr("\n1 of 1 cases passed, "));
  EXPECT_THAT(t.err, HasSubstr("1 of 2 cases ran: snow-press\n"));
  EXPECT_THAT(t.err, testing::EndsWith("interrupted: 1 of 2 cases were done\n"));
  EXPECT_THAT(t.err, testing::Not(HasSubstr("2 of 2")));
}

}  // namespace
}  // namespace dreampm::test
