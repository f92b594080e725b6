#include "dreampm/base/progress.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "dreampm/base/host.h"

using namespace dreampm;
using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

namespace {

TEST(Progress, DurationsReadAsAPersonSaysThem) {
  EXPECT_EQ(duration_text(-3), "0 s");
  EXPECT_EQ(duration_text(0.4), "0 s");
  EXPECT_EQ(duration_text(59.4), "59 s");
  EXPECT_EQ(duration_text(59.6), "1 min 00 s") << "never 60 s";
  EXPECT_EQ(duration_text(185), "3 min 05 s");
  EXPECT_EQ(duration_text(3599.7), "1 h 00 min") << "never 60 min";
  EXPECT_EQ(duration_text(7800), "2 h 10 min");
}

/// Returns the lines that a test program writes to stderr; in a test run this is no terminal.
template <class Work>
std::string lines_of(Work work) {
  testing::internal::CaptureStderr();
  work();
  return testing::internal::GetCapturedStderr();
}

class ScreenHost final : public Host {
 public:
  void info(const std::string&) override { ++infos; }
  void warning(const std::string&) override {}
  void progress(const std::string& line) override { lines.push_back(line); }
  bool rewrites_progress() const override { return true; }
  void progress_ends() override { ++ends; }
  std::vector<std::string> lines;
  int infos = 0, ends = 0;
};

TEST(Progress, GoesToTheHostThatWasCurrentAtItsStart) {
  ScreenHost host;
  const std::string text = lines_of([&] {
    const HostScope scope(&host);
    Progress progress("surface", 3);
    progress.update(1);
    std::this_thread::sleep_for(std::chrono::milliseconds(210));
    progress.update(2, "frame 2");
    EXPECT_EQ(host.ends, 0);
  });
  EXPECT_EQ(text, "");
  ASSERT_EQ(host.lines.size(), 2u);
  EXPECT_THAT(host.lines[1], AllOf(HasSubstr("surface 2/3"), HasSubstr("frame 2")));
  EXPECT_EQ(host.ends, 1);
  EXPECT_EQ(host.infos, 0);
}

TEST(Progress, SaysHowMuchHowLongAndTheNote) {
  const std::string text = lines_of([] {
    Progress progress("surface", 3);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    progress.update(1, "frame 1");
    progress.update(3, "frame 3");
  });
  EXPECT_THAT(text, ContainsRegex("surface 1/3, [0-9]+ s left  frame 1"));
  EXPECT_THAT(text, ContainsRegex("surface 3/3, [0-9]+ s  frame 3"));
}

TEST(Progress, ALogGetsALineNowAndThenButAlwaysTheLast) {
  const std::string text = lines_of([] {
    Progress progress("simulate", 1000);
    for (std::size_t i = 1; i <= 1000; ++i) progress.update(i);
  });
  EXPECT_THAT(text, HasSubstr("simulate 1/1000"));
  EXPECT_THAT(text, HasSubstr("simulate 1000/1000"));
  EXPECT_THAT(text, Not(HasSubstr("simulate 500/1000"))) << "a fast loop must not flood the log";
}

// A stage resumed at 90 of 100 has done one unit in this time, not 90.
TEST(Progress, AResumedStageDoesNotFlatterThePace) {
  const std::string text = lines_of([] {
    Progress progress("render", 100);
    std::this_thread::sleep_for(std::chrono::milliseconds(400));
    progress.update(90);
  });
  EXPECT_THAT(text, AllOf(HasSubstr("render 90/100, "), Not(HasSubstr("100, 0 s left"))));
}

}  // namespace
