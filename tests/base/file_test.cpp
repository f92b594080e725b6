// A file of a run is whole or absent, whatever happens while it is written.
#include "dreampm/base/file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <stdexcept>
#include <string>

#include "dreampm/base/error.h"

namespace fs = std::filesystem;
using namespace dreampm;
using testing::HasSubstr;

namespace {

/// An empty folder of this test, removed at its end.
class File : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "dm-file-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder = name;
  }
  void TearDown() override { fs::remove_all(folder); }
  std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
  }
  /// Returns the error that `call` throws, as text with the exit code in front: "2: ...".
  template <class Call>
  static std::string error_of(Call call) {
    try {
      call();
    } catch (const Error& e) {
      return std::to_string(e.exit_code()) + ": " + e.what();
    }
    return "no error";
  }
  fs::path folder;
};

TEST_F(File, ReplacesWholeAndLeavesNothingBeside) {
  const fs::path target = folder / "a.txt";
  replace_file_text(target, "first, and longer");
  replace_file_text(target, "second");
  EXPECT_EQ(read_file(target), "second");
  EXPECT_EQ(entries(), 1u);
}

TEST_F(File, WhetherATargetCanBeWrittenIsKnownBefore) {
  check_replaceable(folder / "a.txt");
  EXPECT_EQ(entries(), 0u);
  replace_file_text(folder / "a.txt", "old");
  check_replaceable(folder / "a.txt");
  EXPECT_EQ(read_file(folder / "a.txt"), "old");
  EXPECT_EQ(entries(), 1u);
  const auto error = [&](const fs::path& target) { return error_of([&] { check_replaceable(target); }); };
  EXPECT_THAT(error(folder), HasSubstr("2: " + folder.string() + ": is a folder"));
  EXPECT_THAT(error(folder / "none" / "b.txt"), HasSubstr("there is no folder " + (folder / "none").string()));
  EXPECT_THAT(error(folder / "a.txt" / "b.txt"), HasSubstr("a.txt is a file"));
  EXPECT_THAT(error("/proc/b.txt"), HasSubstr("2: /proc/b.txt: cannot be written: "));
}

TEST_F(File, OldContentStandsUntilTheNewIsWhole) {
  const fs::path target = folder / "a.txt";
  replace_file_text(target, "old");
  replace_file(target, [&](const fs::path& temporary) {
    write_bytes(temporary, "new", 3);
    EXPECT_EQ(read_file(target), "old");
  });
  EXPECT_EQ(read_file(target), "new");
}

TEST_F(File, AnExceptionKeepsTheOldFileAndCleansUp) {
  const fs::path target = folder / "a.txt";
  replace_file_text(target, "old");
  EXPECT_THROW(replace_file(target,
                            [](const fs::path& temporary) {
                              write_bytes(temporary, "half", 4);
                              throw std::logic_error("in the middle");
                            }),
               std::logic_error);
  EXPECT_EQ(read_file(target), "old");
  EXPECT_EQ(entries(), 1u) << "the half-written file must be gone";
}

TEST_F(File, BytesOfAnyKindComeBack) {
  std::string text(100'000, '\0');
  for (std::size_t i = 0; i < text.size(); ++i) text[i] = static_cast<char>(i * 7 % 256);
  replace_file_text(folder / "b", text);
  EXPECT_EQ(read_file(folder / "b"), text);
}

TEST_F(File, ErrorsNameThePathAndTheReason) {
  EXPECT_THAT(error_of([&] { read_file(folder / "none"); }), HasSubstr("none: cannot be read: No such file"));
  EXPECT_THAT(error_of([&] { read_file(folder); }), HasSubstr("is a folder"));
  replace_file_text(folder / "file", "x");
  const std::string under = error_of([&] { make_folder(folder / "file" / "out"); });
  EXPECT_THAT(under, HasSubstr("2: "));
  EXPECT_THAT(under, HasSubstr((folder / "file" / "out").string()));
  EXPECT_THAT(error_of([&] { make_folder(folder / "file"); }), HasSubstr("2: "));
  EXPECT_THAT(error_of([&] { replace_file_text(folder / "gone" / "a", "x"); }), HasSubstr("1: "));
}

// A full disk, as far as a test may make one: a limit on the size of files, in a child process.
// Exit codes of the child: 0 all as promised, 3 no error, 4 a wrong text, 5 the old file was lost,
// 6 something was left behind.
TEST_F(File, AFullDiskIsAnErrorAndLosesNothing) {
  const fs::path target = folder / "a.txt";
  replace_file_text(target, "old");
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const rlimit limit{10'000, 10'000};
    signal(SIGXFSZ, SIG_IGN);
    if (setrlimit(RLIMIT_FSIZE, &limit) != 0) _exit(7);
    const std::string what = error_of([&] { replace_file_text(target, std::string(20'000, 'x')); });
    int code = 0;
    if (what == "no error")
      code = 3;
    else if (what.find("1: ") != 0 || what.find(folder.string()) == std::string::npos ||
             what.find("File too large") == std::string::npos)
      code = 4;
    else if (read_file(target) != "old")
      code = 5;
    else if (entries() != 1)
      code = 6;
    _exit(code);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status)) << "ended by signal " << WTERMSIG(status);
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

}  // namespace
