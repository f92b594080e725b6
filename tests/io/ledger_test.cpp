#include "dreampm/io/ledger.h"

#include <cmath>
#include <limits>

#include "files.h"

namespace dreampm {
namespace {
namespace fs = std::filesystem;
using test::message_of;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

const std::vector<std::string> columns = {"frame", "time", "substeps", "limiter", "mass", "kinetic"};

LedgerRow row(int frame) {
  return {
      frame, "wave", {{"time", (frame - 1) / 24.0}, {"substeps", 40.0 * frame}, {"mass", 0.1}, {"kinetic", 1e-300}}};
}

TEST(Ledger, NumbersReadBackExactly) {
  const fs::path file = test::fresh_folder() / "ledger.csv";
  LedgerWriter out(file, columns);
  const double values[] = {
      0.1, 1.0 / 3, 5e-324, std::numeric_limits<double>::max(), -0.0, 1e22, std::nextafter(1.0, 2.0)};
  int frame = 0;
  for (const double v : values) {
    LedgerRow r = row(++frame);
    r.values["mass"] = v;
    out.append(r);
  }
  LedgerRow wild = row(++frame);
  wild.values["mass"] = std::numeric_limits<double>::infinity();
  wild.values["kinetic"] = std::numeric_limits<double>::quiet_NaN();
  out.append(wild);
  const Ledger in = read_ledger(file);
  EXPECT_EQ(in.columns, columns);
  ASSERT_EQ(in.rows.size(), std::size(values) + 1);
  for (std::size_t i = 0; i < std::size(values); ++i) {
    EXPECT_EQ(in.rows[i].frame, static_cast<int>(i) + 1);
    EXPECT_EQ(in.rows[i].limiter, "wave");
    EXPECT_EQ(in.rows[i].values.at("mass"), values[i]);
    EXPECT_EQ(std::signbit(in.rows[i].values.at("mass")), std::signbit(values[i]));
    EXPECT_EQ(in.rows[i].values.at("kinetic"), 1e-300);
  }
  EXPECT_EQ(in.rows.back().values.at("mass"), std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(in.rows.back().values.at("kinetic")));
  // Which sign a division of 0 by 0 gives hangs on the processor.
  EXPECT_EQ(exact_text(-std::numeric_limits<double>::quiet_NaN()), "nan");
}

TEST(Ledger, ReadsAsPlainCsv) {
  const fs::path file = test::fresh_folder() / "ledger.csv";
  LedgerWriter out(file, columns);
  out.append(row(1));
  out.append(row(2));
  EXPECT_EQ(read_file(file),
            "frame,time,substeps,limiter,mass,kinetic\n"
            "1,0,40,wave,0.1,1e-300\n"
            "2,0.041666666666666664,80,wave,0.1,1e-300\n");
}

TEST(Ledger, AResumedRunKeepsTheRowsUpToItsFrame) {
  const fs::path file = test::fresh_folder() / "ledger.csv";
  std::string uninterrupted;
  {
    LedgerWriter out(file, columns);
    for (int f = 1; f <= 9; ++f) out.append(row(f));
    uninterrupted = read_file(file);
  }
  replace_file_text(file, uninterrupted + "10,0.3,4");  // killed within a row
  LedgerWriter out(file, columns, 6);
  EXPECT_EQ(read_ledger(file).rows.size(), 6u);
  for (int f = 7; f <= 9; ++f) out.append(row(f));
  EXPECT_EQ(read_file(file), uninterrupted);
}

TEST(Ledger, WrongRowsAndColumnsAreRefused) {
  const fs::path file = test::fresh_folder() / "ledger.csv";
  const auto error = [](const auto& call) { return message_of<InputError>(call); };
  LedgerWriter out(file, columns);
  out.append(row(3));
  EXPECT_THAT(error([&] { out.append(row(3)); }), HasSubstr("frame 3 cannot follow frame 3"));
  LedgerRow r = row(4);
  r.values.erase("mass");
  EXPECT_THAT(error([&] { out.append(r); }), HasSubstr("no value for column mass"));
  r = row(4);
  r.values["volume"] = 1;
  EXPECT_THAT(error([&] { out.append(r); }), HasSubstr("no column volume"));
  r = row(4);
  r.limiter = "mood";
  EXPECT_THAT(error([&] { out.append(r); }), AllOf(HasSubstr("\"mood\""), HasSubstr("viscosity")));
  EXPECT_EQ(read_ledger(file).rows.size(), 1u);
  EXPECT_THAT(error([&] { LedgerWriter(file, {"time", "frame"}); }), HasSubstr("first column must be \"frame\""));
  EXPECT_THAT(error([&] { LedgerWriter(file, {"frame", "mass", "mass"}); }), HasSubstr("mass is there twice"));
  EXPECT_THAT(error([&] { LedgerWriter(file, {"frame", "mass"}, 3); }), HasSubstr("its columns are frame,time"));
  EXPECT_EQ(read_ledger(file).rows.size(), 1u);
}

TEST(Ledger, DamagedFilesAreNamedWithTheirLine) {
  const fs::path file = test::fresh_folder() / "ledger.csv";
  const auto error = [&](const std::string& text) {
    replace_file_text(file, text);
    return message_of<InputError>([&] { read_ledger(file); });
  };
  EXPECT_THAT(error(""), HasSubstr("no ledger"));
  EXPECT_THAT(error("garbage\n"), HasSubstr("first column"));
  EXPECT_THAT(error("frame,mass\n1,2\n2\n"), HasSubstr("ledger.csv:3: 1 values, but there are 2 columns"));
  EXPECT_THAT(error("frame,mass\n1,two\n"), HasSubstr("ledger.csv:2: \"two\" in column mass is no number"));
  EXPECT_THAT(error("frame,mass\n1.5,2\n"), HasSubstr("column frame"));
  EXPECT_THAT(error("frame,mass\n2,2\n1,2\n"), HasSubstr("frame 1 follows frame 2"));
  fs::remove(file);
  EXPECT_THAT(message_of<InputError>([&] { LedgerWriter(file, columns, 3); }), HasSubstr("cannot be read"));
}

TEST(Ledger, AFullDiskLeavesNoHalfRow) {
  const fs::path file = test::fresh_folder() / "ledger.csv";
  LedgerWriter out(file, columns);
  out.append(row(1));
  const std::string before = read_file(file);
  {
    const test::FileSizeLimit small(before.size() + 5);
    EXPECT_THAT(message_of<RunError>([&] { out.append(row(2)); }), StartsWith(file.string() + ": cannot be written"));
  }
  EXPECT_EQ(read_file(file), before);
  out.append(row(2));
  EXPECT_EQ(read_ledger(file).rows.size(), 2u);
}

TEST(Ledger, TheFormatsColumnsAreAll) {
  EXPECT_EQ(ledger_columns().size(), 56u);
  EXPECT_EQ(ledger_columns().front(), "frame");
  EXPECT_EQ(ledger_columns()[16], "angular_y");
  EXPECT_EQ(ledger_columns().back(), "swollen");
  EXPECT_NO_THROW(LedgerWriter(test::fresh_folder() / "ledger.csv", ledger_columns()));
}

}  // namespace
}  // namespace dreampm
