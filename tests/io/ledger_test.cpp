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

LedgerRow row(int frame) {
  LedgerRow row;
  row.frame = frame, row.limiter = Limiter::wave, row.time = (frame - 1) / 24.0, row.substeps = 40.0 * frame;
  row.mass = 0.1, row.kinetic = 1e-300;
  return row;
}

std::vector<std::string> names_of(const LedgerKind& kind) {
  std::vector<std::string> names;
  for (const LedgerCell& cell : ledger_cells(kind)) names.push_back(cell.name());
  return names;
}

TEST(Ledger, NumbersReadBackExactly) {
  const fs::path file = test::fresh_folder() / "ledger.csv";
  LedgerWriter out(file, LedgerKind{});
  const double values[] = {
      0.1, 1.0 / 3, 5e-324, std::numeric_limits<double>::max(), -0.0, 1e22, std::nextafter(1.0, 2.0)};
  int frame = 0;
  for (const double v : values) {
    LedgerRow r = row(++frame);
    r.mass = v;
    out.append(r);
  }
  LedgerRow wild = row(++frame);
  wild.mass = std::numeric_limits<double>::infinity();
  wild.kinetic = std::numeric_limits<double>::quiet_NaN();
  out.append(wild);
  const Ledger in = read_ledger(file);
  EXPECT_EQ(in.columns, names_of({}));
  ASSERT_EQ(in.rows.size(), std::size(values) + 1);
  for (std::size_t i = 0; i < std::size(values); ++i) {
    EXPECT_EQ(in.rows[i].frame, static_cast<int>(i) + 1);
    EXPECT_EQ(in.rows[i].limiter, Limiter::wave);
    EXPECT_EQ(in.rows[i].mass, values[i]);
    EXPECT_EQ(std::signbit(in.rows[i].mass), std::signbit(values[i]));
    EXPECT_EQ(in.rows[i].kinetic, 1e-300);
  }
  EXPECT_EQ(in.rows.back().mass, std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(in.rows.back().kinetic));
  // The sign of 0 divided by 0 depends on the processor.
  EXPECT_EQ(exact_text(-std::numeric_limits<double>::quiet_NaN()), "nan");
}

TEST(Ledger, ReadsAsPlainCsv) {
  const fs::path file = test::fresh_folder() / "ledger.csv";
  LedgerWriter out(file, {});
  out.append(row(1));
  out.append(row(2));
  const std::string text = read_file(file);
  EXPECT_THAT(text, StartsWith("frame,time,substeps,dt_min,dt_max,limiter,stages,particles,left,mass,"));
  EXPECT_THAT(text, HasSubstr("\n1,0,40,0,0,wave,0,0,0,0.1,"));
  EXPECT_THAT(text, HasSubstr("\n2,0.041666666666666664,80,0,0,wave,0,0,0,0.1,"));
  EXPECT_THAT(text, testing::EndsWith(",0\n"));
}

/// A number of its own for each one of a row.
LedgerRow counted_row(const LedgerKind& kind) {
  LedgerRow all;
  all.frame = 3, all.limiter = Limiter::viscosity;
  double next = 1;
  for (const LedgerCell& cell : ledger_cells(kind))
    if (cell.name() != "frame" && cell.name() != "limiter") ledger_number(all, cell.name()) = next++ / 7;
  return all;
}

TEST(Ledger, EachColumnShowsAnotherMemberAndReadsBack) {
  for (const LedgerKind& kind : {LedgerKind{}, LedgerKind{.emitters = true}, LedgerKind{.projection = true},
                                 LedgerKind{.emitters = true, .projection = true}}) {
    const fs::path file = test::fresh_folder() / "ledger.csv";
    LedgerWriter(file, kind).append(counted_row(kind));
    const Ledger in = read_ledger(file);
    EXPECT_EQ(in.columns, names_of(kind));
    ASSERT_EQ(in.rows.size(), 1u);
    double next = 1;
    for (const std::string& name : in.columns)
      if (name != "frame" && name != "limiter") {
        EXPECT_EQ(ledger_number(in.rows[0], name), next++ / 7) << name;
      }
  }
}

TEST(Ledger, ANumberIsFoundByItsColumn) {
  LedgerRow one;
  one.wall_impulse = {1, 2, 3};
  EXPECT_EQ(ledger_number(one, "wall_impulse_y"), 2);
  for (const char* name : {"wall_impulse", "wall_impulse_w", "limiter", "frame", "mood"})
    EXPECT_THAT(message_of<InputError>([&] { ledger_number(one, name); }),
                StartsWith('"' + std::string(name) + "\" is no number of a ledger"));
}

TEST(Ledger, AResumedRunKeepsTheRowsUpToItsFrame) {
  const fs::path file = test::fresh_folder() / "ledger.csv";
  std::string uninterrupted;
  {
    LedgerWriter out(file, LedgerKind{});
    for (int f = 1; f <= 9; ++f) out.append(row(f));
    uninterrupted = read_file(file);
  }
  replace_file_text(file, uninterrupted + "10,0.3,4");  // killed within a row
  LedgerWriter out(file, LedgerKind{}, 6);
  EXPECT_EQ(read_ledger(file).rows.size(), 6u);
  for (int f = 7; f <= 9; ++f) out.append(row(f));
  EXPECT_EQ(read_file(file), uninterrupted);
}

TEST(Ledger, WrongRowsAndColumnsAreRefused) {
  const fs::path file = test::fresh_folder() / "ledger.csv";
  const auto error = [](const auto& call) { return message_of<InputError>(call); };
  LedgerWriter out(file, LedgerKind{});
  out.append(row(3));
  EXPECT_THAT(error([&] { out.append(row(3)); }), HasSubstr("frame 3 cannot follow frame 3"));
  EXPECT_EQ(read_ledger(file).rows.size(), 1u);
  EXPECT_THAT(error([&] { LedgerWriter(file, {.emitters = true}, 3); }),
              AllOf(HasSubstr("its columns are frame,time"), HasSubstr("this run writes"), HasSubstr("entered_mass")));
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
  EXPECT_THAT(error("time,frame\n"), HasSubstr("first column must be \"frame\""));
  EXPECT_THAT(error("frame,mass,mass\n"), HasSubstr("mass is there twice"));
  EXPECT_THAT(error("frame,moment\n"), HasSubstr("\"moment\" is no column of a ledger"));
  EXPECT_THAT(error("frame,limiter\n1,mood\n"), AllOf(HasSubstr(":2: limiter \"mood\""), HasSubstr("viscosity")));
  EXPECT_THAT(error("frame,mass\n1.5,2\n"), HasSubstr("column frame"));
  EXPECT_THAT(error("frame,mass\n2,2\n1,2\n"), HasSubstr("frame 1 follows frame 2"));
  fs::remove(file);
  EXPECT_THAT(message_of<InputError>([&] { LedgerWriter(file, {}, 3); }), HasSubstr("cannot be read"));
}

TEST(Ledger, AFullDiskLeavesNoHalfRow) {
  const fs::path file = test::fresh_folder() / "ledger.csv";
  LedgerWriter out(file, LedgerKind{});
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
  const std::vector<std::string> names = names_of({});
  EXPECT_EQ(names.size(), 56u);
  EXPECT_EQ(names.front(), "frame");
  EXPECT_EQ(names[16], "angular_y");
  EXPECT_EQ(names.back(), "swollen");
  EXPECT_EQ(names_of({.emitters = true}).size(), 65u);
  EXPECT_EQ(names_of({.emitters = true, .projection = true}).back(), "dissipated_projection");
}

}  // namespace
}  // namespace dreampm
