// Planted errors: each errors/NAME.yaml must give exactly the lines of errors/NAME.txt.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "dreampm/base/file.h"
#include "dreampm/scene/parse.h"
#include "dreampm/version.h"

namespace dreampm::scene {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> planted() {
  std::vector<fs::path> found;
  for (const auto& f : fs::directory_iterator(fs::path(DM_SOURCE_DIR) / "tests/scene/errors"))
    if (f.path().extension() == ".yaml") found.push_back(f.path());
  std::sort(found.begin(), found.end());
  return found;
}

/// The text without this build's version.
std::string reported(const fs::path& p) {
  std::string text = parse_scene_text(read_file(p), p.filename().string()).text();
  const std::string name = std::string("DreaMPM ") + version;
  for (std::size_t at = 0; (at = text.find(name, at)) != text.npos;) text.replace(at, name.size(), "DreaMPM VERSION");
  return text;
}

class Planted : public testing::TestWithParam<fs::path> {};

TEST_P(Planted, IsToldExactly) {
  EXPECT_EQ(reported(GetParam()), read_file(fs::path(GetParam()).replace_extension(".txt")));
}

INSTANTIATE_TEST_SUITE_P(Errors, Planted, testing::ValuesIn(planted()), [](const auto& p) {
  std::string name = p.param.stem().string();
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(Errors, AreManyAndPrecise) {
  std::size_t lines = 0;
  for (const fs::path& p : planted()) {
    const ParseResult r = parse_scene_text(read_file(p), p.filename().string());
    lines += r.problems.size();
  }
  EXPECT_GE(planted().size(), 25u);
  EXPECT_GE(lines, 60u);
}

}  // namespace
}  // namespace dreampm::scene
