// The lock of a run's folder: one holder, named; gone with its process; no folder left where
// nothing was kept.
#include "dreampm/pipeline/run_lock.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"

namespace dreampm {
namespace {
namespace fs = std::filesystem;

class Lock : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "dreampm-lock-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }

  static std::string refusal(const fs::path& folder) {
    try {
      const RunLock lock(folder);
    } catch (const InputError& e) {
      return e.what();
    }
    return "none";
  }
  fs::path folder_;
};

TEST_F(Lock, NamesTheProcessThatHoldsIt) {
  {
    const RunLock lock(folder_);
    EXPECT_THAT(refusal(folder_),
                testing::HasSubstr("process " + std::to_string(::getpid()) + " works in this folder"));
  }
  EXPECT_EQ(refusal(folder_), "none");
}

TEST_F(Lock, IsGoneWithAProcessThatWasKilled) {
  int ready[2];
  ASSERT_EQ(::pipe(ready), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    const RunLock lock(folder_);
    if (::write(ready[1], "x", 1) != 1) ::_exit(1);
    ::pause();
    ::_exit(0);
  }
  char byte = 0;
  ASSERT_EQ(::read(ready[0], &byte, 1), 1);
  EXPECT_THAT(refusal(folder_), testing::HasSubstr("process " + std::to_string(child)));
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  EXPECT_EQ(refusal(folder_), "none");
  ::close(ready[0]), ::close(ready[1]);
}

TEST_F(Lock, RemovesWhatItMadeUnlessItIsKept) {
  {
    const RunLock lock(folder_ / "out/deep/run");
  }
  EXPECT_FALSE(fs::exists(folder_ / "out"));
  EXPECT_TRUE(fs::exists(folder_));
  {
    RunLock lock(folder_ / "out/deep/run/");
    replace_file_text(folder_ / "out/other", "of another run");
  }
  EXPECT_TRUE(fs::exists(folder_ / "out/other"));
  EXPECT_FALSE(fs::exists(folder_ / "out/deep"));
  {
    RunLock lock(folder_ / "out/deep/run");
    lock.keep();
  }
  EXPECT_TRUE(fs::exists(folder_ / "out/deep/run"));
  {
    const RunLock lock(folder_ / "out/deep/run");
  }
  EXPECT_TRUE(fs::exists(folder_ / "out/deep/run")) << "it was there before";
}

}  // namespace
}  // namespace dreampm
