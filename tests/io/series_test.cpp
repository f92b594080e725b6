#include "dreampm/io/series.h"

#include <cmath>
#include <limits>

#include "dreampm/io/append.h"
#include "files.h"

namespace dreampm {
namespace {
namespace fs = std::filesystem;
using test::message_of;
using testing::HasSubstr;

TEST(Series, NumbersReadBackExactly) {
  const fs::path file = test::fresh_folder() / "level.csv";
  SeriesWriter out(file, {"height", "speed"});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  out.append(0, std::vector{0.1, nan});
  out.append(1.0 / 24, std::vector{1.0 / 3, -5e-324});
  const Series in = read_series(file);
  EXPECT_EQ(in.columns, (std::vector<std::string>{"time", "height", "speed"}));
  EXPECT_EQ(in.column("time"), (std::vector{0, 1.0 / 24}));
  EXPECT_EQ(in.column("height"), (std::vector{0.1, 1.0 / 3}));
  EXPECT_TRUE(std::isnan(in.rows[0][2]));
  EXPECT_EQ(in.rows[1][2], -5e-324);
  EXPECT_THAT(message_of<InputError>([&] { in.column("depth"); }),
              HasSubstr("no column depth; there are time, height, speed"));
}

TEST(Series, AResumedRunKeepsRowsUpToItsTime) {
  const fs::path file = test::fresh_folder() / "level.csv";
  {
    SeriesWriter out(file, {"height"});
    for (int i = 0; i < 6; ++i) out.append(0.1 * i, std::vector{double(i)});
  }
  append_text(file, "0.7,3");  // a killed run's half row
  SeriesWriter again(file, {"height"}, 0.1 * 3);
  again.append(0.35, std::vector{9.0});
  EXPECT_EQ(read_series(file).column("height"), (std::vector{0.0, 1.0, 2.0, 3.0, 9.0}));
}

TEST(Series, WhatDoesNotFitIsRefused) {
  const fs::path folder = test::fresh_folder(), file = folder / "level.csv";
  SeriesWriter out(file, {"height"});
  out.append(1, std::vector{1.0});
  EXPECT_THAT(message_of<InputError>([&] { out.append(1, std::vector{1.0}); }),
              HasSubstr("time 1 cannot follow time 1"));
  EXPECT_THAT(message_of<InputError>([&] { out.append(2, std::vector{1.0, 2.0}); }),
              HasSubstr("3 values for 2 columns"));
  EXPECT_THAT(message_of<InputError>([&] { SeriesWriter(file, {"depth"}, 9.0); }),
              HasSubstr("this run writes time,depth"));
  EXPECT_THAT(message_of<InputError>([&] { SeriesWriter(folder / "none.csv", {"depth"}, 9.0); }),
              HasSubstr("none.csv"));
  append_text(file, "2,x\n");
  EXPECT_THAT(message_of<InputError>([&] { read_series(file); }), HasSubstr("level.csv:3: \"x\" is no number"));
}

}  // namespace
}  // namespace dreampm
