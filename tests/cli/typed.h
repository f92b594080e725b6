// Types a line as a user does, in a folder of the test's own.
#pragma once
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
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

  /// `dreampm LINE` in the folder. The line holds no quotes. `before`: for the shell, such as a
  /// limit.
  Typed type(const std::string& line, const std::string& before = ":") const {
    return shell(before + " && '" + DM_COMMAND + "' " + line);
  }
  /// The same, stopped by SIGTERM once `file` is there.
  Typed stop_at(const std::string& file, const std::string& line) const {
    return shell(std::string("'") + DM_COMMAND + "' " + line + " & until [ -e " + file +
                 " ]; do sleep 0.01; done; kill $!; wait $!");
  }
  /// A shell's script in the folder; it holds no quotes but those of DM_COMMAND.
  Typed shell(const std::string& script) const {
    const std::string command = "cd '" + folder.string() + "' && { " + script + "; } >.out 2>.err";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), read_file(folder / ".out"),
            read_file(folder / ".err")};
  }
  /// Exit code 2, these words on stderr, and nothing else.
  void expect_refused(const std::string& line, const std::string& words) const {
    const Typed t = type(line);
    EXPECT_EQ(t.code, 2) << line << ": " << t.err;
    EXPECT_NE(t.err.find(words), std::string::npos) << line << ": " << t.err;
    EXPECT_EQ(t.out, "") << line;
  }
  void write(const std::string& name, const std::string& text) const { replace_file_text(folder / name, text); }
  /// Returns the record in a run's folder.
  nlohmann::json record(const std::string& run) const {
    return nlohmann::json::parse(read_file(folder / run / "run.json"));
  }

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

/// Beside dam.yaml, which is tiny_dam and runs into out/dam.
class TypingAtADam : public Typing {
 protected:
  void SetUp() override {
    Typing::SetUp();
    write("dam.yaml", tiny_dam);
  }
};

/// A cube of one meter, as an OFF file.
inline constexpr const char* cube =
    "OFF\n8 6 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"
    "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 2 3 7 6\n4 1 2 6 5\n4 0 4 7 3\n";

}  // namespace dreampm::test
