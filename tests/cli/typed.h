// Types a line as a user does, in a folder of the test's own.
#pragma once
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "dreampm/base/file.h"

namespace dreampm::test {

struct Typed {
  int code = -1;
  std::string out, err;
};

class Typing : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder = std::filesystem::temp_directory_path() /
             (std::string("dreampm-") + info->name() + "-" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
  }
  void TearDown() override { std::filesystem::remove_all(folder); }

  /// `dreampm LINE` in the folder. The line holds no quotes. `before`: for the shell, such as a limit.
  Typed type(const std::string& line, const std::string& before = ":") const {
    return shell(before + " && '" + DM_COMMAND + "' " + line);
  }
  /// A shell's script in the folder; it holds no quotes but those of DM_COMMAND.
  Typed shell(const std::string& script) const {
    const std::string command = "cd '" + folder.string() + "' && { " + script + "; } >.out 2>.err";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), read_file(folder / ".out"),
            read_file(folder / ".err")};
  }
  void write(const std::string& name, const std::string& text) const { replace_file_text(folder / name, text); }

  std::filesystem::path folder;
};

/// 800 particles, three small frames.
inline const std::string tiny_dam = R"(dreampm: 1
name: dam
space: {min: [0, 0, 0], max: [0.6, 0.4, 0.3], spacing: 0.03, walls: {ceiling: {type: open}}}
time: {fps: 24, frames: 3, cfl: 0.5}
materials:
  water: {type: newtonian, max_compression: 0.05}
bodies:
  column: {material: water, shape: {box: {min: [0, 0, 0], max: [0.24, 0.3, 0.3]}}}
output: {folder: out/dam}
render: {size: [64, 36], samples: 4, noise: 0.1}
)";

}  // namespace dreampm::test
