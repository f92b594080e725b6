// Files, limits and messages for the tests of io.
#pragma once
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <string>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "thrown.h"

namespace dreampm::test {

/// A folder of its own for the running test, empty at first.
inline std::filesystem::path fresh_folder() {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  const std::filesystem::path folder =
      std::filesystem::path(DM_BINARY_DIR) / "test-files" / (std::string(test->test_suite_name()) + "." + test->name());
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

/// While it lives, no file may grow beyond `bytes`: writing on says "File too large", as a full
/// disk says its own.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    rlimit small = before_;
    small.rlim_cur = bytes;
    setrlimit(RLIMIT_FSIZE, &small);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int);
};

/// The message of `read` for a file NAME of each of the bytes.
template <class Read>
auto refusal_of(const std::filesystem::path& folder, const std::string& name, const Read& read) {
  return [=](const std::string& bytes) {
    replace_file_text(folder / name, bytes);
    return message_of<InputError>([&] { read(folder / name); });
  };
}

/// What every format of pictures does with no file, a folder and an empty file.
template <class Read>
void expect_no_picture(const std::filesystem::path& folder, const std::string& ending, const Read& read) {
  const std::string none = "none." + ending;
  EXPECT_THAT(message_of<InputError>([&] { read(folder / none); }), testing::HasSubstr(none + ": cannot be read"));
  EXPECT_THAT(message_of<InputError>([&] { read(folder); }), testing::HasSubstr("is a folder"));
  EXPECT_THAT(refusal_of(folder, "bad." + ending, read)(""),
              testing::HasSubstr("bad." + ending + ": the file is empty"));
}

/// What every format of pictures does with a file that ends at one of `sizes`, or has a bit wrong
/// at `flip`.
template <class Read>
void expect_damage_is_named(const std::filesystem::path& folder, const std::string& ending, const Read& read,
                            const std::string& whole, std::initializer_list<std::size_t> sizes, std::size_t flip) {
  const auto error = refusal_of(folder, "bad." + ending, read);
  for (const std::size_t size : sizes)
    EXPECT_THAT(error(whole.substr(0, size)),
                testing::AllOf(testing::HasSubstr("bad." + ending), testing::HasSubstr("damaged")))
        << size;
  std::string flipped = whole;
  flipped[flip] = static_cast<char>(flipped[flip] ^ 16);
  EXPECT_THAT(error(flipped), testing::HasSubstr("damaged"));
}

/// How many files lie in a folder.
inline std::size_t files_in(const std::filesystem::path& folder) {
  std::size_t n = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder)) ++n;
  return n;
}

/// How many descriptors this process has open.
inline std::size_t open_descriptors() { return files_in("/proc/self/fd"); }

}  // namespace dreampm::test
