// `check` of a container, and `info --fill` of its run.
#include <gmock/gmock.h>

#include "typed.h"

namespace dreampm::test {
namespace {
using nlohmann::json;
using testing::HasSubstr;

const std::string cups = R"(dreampm: 1
name: cups
space: {min: [0, 0, 0], max: [0.8, 0.4, 0.4], spacing: 0.02}
time: {fps: 24, frames: 2}
materials: {water: {type: newtonian}}
bodies:
  pool: {material: water, shape: {box: {min: [0.08, 0.06, 0.08], max: [0.32, 0.26, 0.32]}}}
colliders:
  one: {shape: {container: {box: {size: [0.24, 0.2, 0.24]}, wall: 0.06, cut: 0}, center: [0.2, 0.13, 0.2]}}
  two: {shape: {container: {sphere: {radius: 0.1}, wall: 0.06, cut: 0.1}, center: [0.6, 0.08, 0.2]}}
output: {folder: out/cups}
)";

TEST_F(Typing, FillIsReportedOfEveryContainer) {
  write("cups.yaml", cups);
  const Typed check = type("check cups.yaml");
  EXPECT_EQ(check.code, 0) << check.err;
  EXPECT_THAT(check.out, HasSubstr("collider one: its hollow holds 0.0115"));
  EXPECT_THAT(check.out, HasSubstr("collider two: its hollow holds 0.0021"));
  EXPECT_EQ(type("run cups.yaml").code, 0);
  const Typed said = type("info out/cups --fill --json --frame 1");
  EXPECT_EQ(said.code, 0) << said.err;
  const json all = json::parse(said.out), fill = all.at("fill");
  EXPECT_EQ(fill.at("collider"), "one");
  EXPECT_EQ(fill.at("frame"), 1);
  EXPECT_EQ(fill.at("fraction"), 1);
  EXPECT_EQ(fill.at("pockets"), json::array());
  EXPECT_EQ(all.at("others").at(0).at("collider"), "two");
  EXPECT_EQ(all.at("others").at(0).at("filled_m3"), 0);
  EXPECT_GT(all.at("others").at(0).at("leaked_m3").get<double>(), 0) << "the water in the other one, below its rim";
  EXPECT_THAT(type("info out/cups --fill").out, HasSubstr("frame 2, 0.0416667 s\none              0.0"));
}

TEST_F(Typing, FillIsRefusedWhereThereIsNone) {
  write("cups.yaml", cups);
  EXPECT_EQ(type("run cups.yaml --frames 1").code, 0);
  const Typed late = type("info out/cups --fill --frame 9");
  EXPECT_EQ(late.code, 2);
  EXPECT_THAT(late.err, HasSubstr("has no frame 9"));
  EXPECT_EQ(type("info cups.yaml --fill").code, 2) << "no run";
  EXPECT_EQ(type("info out/cups --frame 1").code, 2) << "--frame is of --fill";
}

}  // namespace
}  // namespace dreampm::test
