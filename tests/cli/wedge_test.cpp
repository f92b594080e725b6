// A scene for every combination of some values, compared in a table and on a sheet.
#include <gmock/gmock.h>

#include <sstream>

#include "dreampm/io/png.h"
#include "typed.h"

namespace dreampm::test {
namespace {
namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

class Wedge : public Typing {
 protected:
  void SetUp() override {
    Typing::SetUp();
    std::string scene = tiny_dam;
    const std::string size = "size: [64, 36], samples: 4, noise: 0.1";
    scene.replace(scene.find(size), size.size(),
                  "size: [128, 72], samples: 4, noise: 0.2, caustics: false, stage: {floor: none}");
    write("dam.yaml", scene + "probes: {level: {type: height, at: [0.1, 0.15]}}\n");
  }
  std::vector<std::string> lines_of(const std::string& file) const {
    std::istringstream in(read_file(folder / file));
    std::vector<std::string> lines;
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
  }
};

TEST_F(Wedge, EveryCombinationHasAFolderARowAndItsPlaceOnTheSheet) {
  Typed t = type("wedge dam.yaml space.spacing=0.06,0.05 gravity=[0,-9.81,0],[0,-1.6,0] --set time.frames=2 --jobs 2");
  ASSERT_EQ(t.code, 0) << t.err;
  EXPECT_THAT(t.out, HasSubstr("out/dam-wedge/wedge.csv\nout/dam-wedge/contact-sheet.png\n"));
  EXPECT_THAT(t.out, HasSubstr("space.spacing  gravity      status    frames  particles  volume"));
  const std::vector<std::string> table = lines_of("out/dam-wedge/wedge.csv");
  ASSERT_EQ(table.size(), 5u);
  EXPECT_EQ(table[0],
            "folder,space.spacing,gravity,status,frames,particles,volume_kept,dt_min,substeps,seconds,state_hash,"
            "level.height");
  EXPECT_THAT(table[1], HasSubstr(R"(,0.06,"[0,-9.81,0]",complete,2,)"));
  EXPECT_THAT(table[4], HasSubstr(R"(,0.05,"[0,-1.6,0]",complete,2,)"));
  // A run is what a scene gives alone, its row what the run's files say.
  ASSERT_EQ(type("run dam.yaml --set time.frames=2 --set space.spacing=0.06 --out alone").code, 0);
  const nlohmann::json frames = record("alone").at("frames");
  EXPECT_THAT(table[1], HasSubstr("," + frames[1].at("state_hash").get<std::string>() + ","));
  const std::string height = lines_of("alone/probes/level.csv").back();
  EXPECT_TRUE(table[1].ends_with(height.substr(height.find(','))));
  // Four rows of two frames, 128 x 72 each, with letters above.
  const RgbImage sheet = read_png(folder / "out/dam-wedge/contact-sheet.png");
  EXPECT_EQ(sheet.width, 6 + 4 * (128 + 6));
  EXPECT_GT(sheet.height, 6 + 4 * (72 + 6));

  t = type("wedge out/dam-wedge");
  EXPECT_EQ(t.code, 0) << t.err;
  EXPECT_EQ(lines_of("out/dam-wedge/wedge.csv"), table);
}

TEST_F(Wedge, GoesOnWhereItWasStopped) {
  const std::string line = "wedge dam.yaml time.cfl=0.5,0.4 --set time.frames=2 --set render.stage.floor=tiles ";
  Typed t = stop_at("out/dam-wedge/cfl=0.5/render/render_000001.png", line);
  EXPECT_EQ(t.code, 130);
  EXPECT_THAT(t.err, HasSubstr("type the same command again to go on"));
  EXPECT_THAT(read_file(folder / "out/dam-wedge/wedge.csv"), HasSubstr(",not run,"));
  t = type(line);
  EXPECT_EQ(t.code, 0) << t.err;
  const std::vector<std::string> table = lines_of("out/dam-wedge/wedge.csv");
  ASSERT_EQ(table.size(), 3u);
  EXPECT_THAT(table[1], HasSubstr(",complete,2,"));
  EXPECT_THAT(table[2], HasSubstr(",complete,2,"));
  EXPECT_THAT(read_file(folder / "out/dam-wedge/log/cfl=0.5.txt"), HasSubstr("going on"));
  ASSERT_EQ(type(line).code, 0);
  EXPECT_EQ(lines_of("out/dam-wedge/wedge.csv"), table) << "nothing was made again";
}

TEST_F(Wedge, ARunThatFailsLeavesTheOthers) {
  // A fixed step of a fifth of a second is longer than a frame.
  const Typed t = type("wedge dam.yaml time.dt=0.001,0.2 --set time.frames=1");
  EXPECT_NE(t.code, 0);
  EXPECT_THAT(t.err, HasSubstr("1 of 2 runs failed\n  dt=0.2: "));
  const std::vector<std::string> table = lines_of("out/dam-wedge/wedge.csv");
  ASSERT_EQ(table.size(), 3u);
  EXPECT_THAT(table[1], HasSubstr("dt=0.001,0.001,complete,1,"));
  EXPECT_THAT(table[2], Not(HasSubstr("complete")));
}

TEST_F(Wedge, AKeyThatIsNoneIsRefusedWithTheNearest) {
  expect_refused("wedge dam.yaml space.spcing=0.03,0.04",
                 "space.spcing=0.03: error: unknown key 'space.spcing'; did you mean 'spacing'?");
  expect_refused("wedge dam.yaml materials.watr.viscosity=1,2",
                 "materials.watr.viscosity: error: no 'watr' in materials; did you mean 'water'?");
  expect_refused("wedge dam.yaml space.spacing=0.03,wide", "space.spacing=wide: error: space.spacing is 'wide'");
  expect_refused("wedge dam.yaml", "no KEY=a,b,c");
  expect_refused("wedge dam.yaml space.spacing", "must read KEY=a,b,c");
  expect_refused("wedge dam.yaml space.spacing=0.03,,0.04", "has an empty value");
  expect_refused("wedge dam.yaml space.spacing=0.03,0.03", "has the value 0.03 twice");
  expect_refused("wedge dam.yaml time.cfl=0.5 time.cfl=0.4", "time.cfl is given twice");
  expect_refused("wedge dam.yaml time.cfl=0.5 --chunk 4", "--chunk requires --to");
  expect_refused("wedge dam.yaml time.cfl=0.5 --to make --jobs 2", "--jobs excludes --to");
  expect_refused("wedge none.yaml time.cfl=0.5", "none.yaml: no such scene file");
  EXPECT_FALSE(fs::exists(folder / "out"));
  fs::create_directories(folder / "other");
  expect_refused("wedge other", "has no wedge.csv: not a wedge's folder");
  write("other/wedge.csv", "folder,a,status\nx,1\n");
  expect_refused("wedge other", "other/wedge.csv:2: 2 cells; its first line has 3");
  write("other/wedge.csv", "name,a\n");
  expect_refused("wedge other", "other/wedge.csv:1: is no table of a wedge");
  write("other/wedge.csv", "folder,a,status\n../x,1,complete\n");
  expect_refused("wedge other", "other/wedge.csv:2: '../x' is no folder of a run");
  expect_refused("wedge other time.cfl=0.5", "is a folder");
}

TEST_F(Wedge, AsAMakefileItGivesTheSameTable) {
  const std::string line = "wedge dam.yaml space.spacing=0.06,0.05 --set time.frames=1 ";
  ASSERT_EQ(type(line + "--out here").code, 0);
  Typed t = type(line + "--to make --chunk 1 --out job");
  ASSERT_EQ(t.code, 0) << t.err;
  EXPECT_THAT(read_file(folder / "job/wedge.csv"), HasSubstr("spacing=0.05,0.05,not run,0"));
  t = shell("env -u MAKEFLAGS -u MAKELEVEL make -C job -j2");
  ASSERT_EQ(t.code, 0) << t.out << t.err;
  const std::vector<std::string> here = lines_of("here/wedge.csv"), there = lines_of("job/wedge.csv");
  ASSERT_EQ(here.size(), there.size());
  const auto without_cost = [](const std::string& row) {
    // The cost is the third cell from the end.
    std::size_t end = row.rfind(',', row.rfind(',') - 1);
    return row.substr(0, row.rfind(',', end - 1)) + row.substr(end);
  };
  for (std::size_t i = 0; i < here.size(); ++i) EXPECT_EQ(without_cost(here[i]), without_cost(there[i]));
  for (const char* run : {"spacing=0.06", "spacing=0.05"})
    EXPECT_EQ(read_file(folder / "here" / run / "dam.mp4"), read_file(folder / "job" / run / "dam.mp4"));
}

}  // namespace
}  // namespace dreampm::test
