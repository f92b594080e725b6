// The page of the validation: made in pieces, and of this version.
#include "validate/page.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "dreampm/base/file.h"
#include "dreampm/version.h"

namespace dreampm::validate {
namespace {
using testing::HasSubstr;
using testing::Not;

Result made(const char* name, double value) {
  Result r;
  r.which = &find_case(name);
  r.metrics = {{"off by", "m", value, 1, Metric::Side::at_most, {}}};
  r.controls = {{"wrong", "off by", "m", 2, 1, Metric::Side::at_most, {}, true}};
  r.plots = {"here/curve.svg"};
  return r;
}

TEST(Page, IsMadeInPieces) {
  const std::string first = page_with({made("slopes", 0.25)}, "images");
  EXPECT_THAT(first,
              HasSubstr(fmt::format("| [slopes](#slopes) | passed at quick resolution by {}, commit ", version)));
  EXPECT_THAT(first, HasSubstr("\n## slopes\n"));
  EXPECT_THAT(first, HasSubstr("![slopes](images/curve.svg)\n"));
  const std::string both = page_with({made("free-fall", 3)}, "images", first);
  EXPECT_THAT(both, HasSubstr("| [free-fall](#free-fall) | FAILED at quick resolution by "));
  EXPECT_THAT(both, HasSubstr("\n- missed: free-fall: off by is 3 m, wanted <= 1 m\n"));
  EXPECT_LT(both.find("\n## free-fall\n"), both.find("\n## slopes\n")) << "in the order of the list";
  EXPECT_TRUE(both.ends_with(first.substr(first.find("\n## slopes\n"))));
  const std::string again = page_with({made("slopes", 0.75)}, "images", both);
  EXPECT_THAT(again, HasSubstr("| off by | 0.75 m |"));
  EXPECT_THAT(again, HasSubstr("| off by | 3 m |"));
  EXPECT_THAT(again, Not(HasSubstr("| off by | 0.25 m |")));
}

TEST(Page, LeavesOutCasesThatAreNoLongerThere) {
  const std::string old =
      "# Validation\n\n## weather\n\nResult: passed.\n\nx\n\n## slopes\n\nof before there were results\n";
  const std::string page = page_with({made("free-fall", 0.5)}, "images", old);
  EXPECT_THAT(page, Not(HasSubstr("weather")));
  EXPECT_THAT(page, Not(HasSubstr("slopes")));
}

/// The cases of `--quick` are run again for each version; the page names the version of the long
/// ones.
TEST(Page, IsOfThisVersion) {
  const std::string page = read_file(std::filesystem::path(DM_SOURCE_DIR) / "docs/validation.md");
  for (const Case* c : all_cases()) {
    const std::string row = fmt::format("| [{0}](#{0}) | ", c->name);
    const std::size_t at = page.find(row);
    ASSERT_NE(at, page.npos) << c->name << ": dreampm validate " << c->name
                             << " --full --markdown docs/validation.md --out docs/images/validation";
    const std::string result = page.substr(at, page.find('\n', at) - at);
    EXPECT_THAT(result, HasSubstr(", commit "));
    if (c->quick) {
      EXPECT_THAT(result, HasSubstr(fmt::format(" by {}, commit ", version)));
    }
  }
}

}  // namespace
}  // namespace dreampm::validate
