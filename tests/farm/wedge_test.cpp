// Which runs a wedge has.
#include "dreampm/farm/wedge.h"

#include <gmock/gmock.h>

#include <set>

#include "thrown.h"

namespace dreampm::farm {
namespace {
using testing::ElementsAre;
using testing::HasSubstr;

TEST(Wedges, CommasWithinBracketsAndQuotesBelongToAValue) {
  EXPECT_THAT(wedge_key("gravity=[0,-9.81,0],[0,0,0]").values, ElementsAre("[0,-9.81,0]", "[0,0,0]"));
  EXPECT_THAT(wedge_key("space.walls.ceiling={type: open},{type: slip, friction: 0.1}").values,
              ElementsAre("{type: open}", "{type: slip, friction: 0.1}"));
  EXPECT_THAT(wedge_key("about=\"one, two\",'three, four'").values, ElementsAre("\"one, two\"", "'three, four'"));
  EXPECT_EQ(wedge_key("a.b=1").path, "a.b");
}

TEST(Wedges, AreEveryCombinationAndTheLastKeyChangesFirst) {
  const Wedge wedge = wedge_of({wedge_key("space.spacing=0.1,0.2"), wedge_key("time.cfl=0.3,0.4,0.5")});
  ASSERT_EQ(wedge.runs.size(), 6u);
  EXPECT_EQ(wedge.runs[1].name, "spacing=0.1,cfl=0.4");
  EXPECT_EQ(wedge.runs[5].name, "spacing=0.2,cfl=0.5");
  EXPECT_THAT(wedge.runs[3].settings(wedge.keys), ElementsAre("space.spacing=0.2", "time.cfl=0.3"));
}

TEST(Wedges, AFolderIsNamedByTheValuesAlone) {
  const auto name = [](const std::string& values) {
    return wedge_of({wedge_key("space.spacing=" + values)}).runs[0].name;
  };
  EXPECT_EQ(name("0.1"), name("0.1,0.2"));
  // What a file's name may not hold, or a shell would read, is kept apart by a hash.
  std::set<std::string> names;
  for (const char* value : {"a/b", "a b", "a$b", "a_b", "../a", "'a'"}) {
    names.insert(name(value));
    EXPECT_THAT(name(value), testing::MatchesRegex("[A-Za-z0-9=,._+-]+")) << value;
  }
  EXPECT_EQ(names.size(), 6u);
  EXPECT_LT(name(std::string(5000, 'x')).size(), 200u);
  // Where two keys end alike the whole paths are there.
  const Wedge alike = wedge_of({wedge_key("materials.water.viscosity=1"), wedge_key("materials.oil.viscosity=2")});
  EXPECT_EQ(alike.runs[0].name, "materials.water.viscosity=1,materials.oil.viscosity=2");
}

TEST(Wedges, MoreThanTenThousandRunsAreRefused) {
  std::string values = "1";
  for (int i = 2; i <= 101; ++i) values += "," + std::to_string(i);
  const std::vector<WedgeKey> keys{wedge_key("a=" + values), wedge_key("b=" + values)};
  EXPECT_THAT(test::refusal([&] { wedge_of(keys); }), HasSubstr("more than 10000 runs"));
}

}  // namespace
}  // namespace dreampm::farm
