// Pages typed as they stand: their scenes are written, their commands run, coarse and short.
#include <gmock/gmock.h>

#include <algorithm>
#include <sstream>

#include "fences.h"
#include "typed.h"

namespace dreampm::test {
namespace {
using testing::HasSubstr;

class Guide : public Typing, public testing::WithParamInterface<const char*> {
 protected:
  void SetUp() override {
    Typing::SetUp();
    std::filesystem::create_directory_symlink(std::filesystem::path(DM_SOURCE_DIR) / "scenes", folder / "scenes");
  }
  /// A scene whose first line is a comment with its name.
  void write_scene(const std::string& text) const {
    const std::size_t end = text.find(".yaml\n");
    if (text.starts_with("# ") && end != std::string::npos) write(text.substr(2, end + 3), text);
  }
  void type_block(const std::string& text) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with("export PATH")) continue;  // the test has a path of its own
      SCOPED_TRACE(line);
      const bool ours = line.starts_with("dreampm ");
      const auto is = [&](const char* verb) { return line.starts_with(std::string("dreampm ") + verb + " "); };
      const bool computes = is("make") || is("run") || is("farm") || is("wedge");
      const std::string coarse =
          std::string(" --set space.spacing=0.04 --set render.size=[32,18] --set render.samples=4 --set ") +
          (is("wedge") ? "time.frames=1" : "time.seconds=0.09");
      const Typed t = ours ? type(line.substr(8) + (computes ? coarse : "")) : shell(line);
      EXPECT_EQ(t.code, 0) << t.err;
      ++typed;
    }
  }
  int typed = 0;
};

TEST_P(Guide, IsTypedAsItStands) {
  const std::string page = read_file(std::filesystem::path(DM_SOURCE_DIR) / "docs" / GetParam());
  for (const Fence& f : fences_of(page)) {
    if (f.language == "yaml") write_scene(f.text);
    if (f.language == "sh") type_block(f.text);
  }
  EXPECT_GE(typed, 1);
}

/// guide/first-film.md: first_film.
std::string name_of_page(const testing::TestParamInfo<const char*>& page) {
  std::string name = std::filesystem::path(page.param).stem();
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Pages, Guide,
                         testing::Values("guide/first-film.md", "guide/foam.md", "guide/first-material.md",
                                         "guide/first-probe.md", "guide/farm.md", "howto/open-in-houdini.md",
                                         "howto/open-in-paraview.md", "howto/editor.md"),
                         name_of_page);

class GuideError : public Typing {};

TEST_F(GuideError, IsTheParsers) {
  write("splash.yaml", "# splash.yaml\ndreampm: 1\nname: splash\nspace: {max: [0.6, 0.6, 0.6], spcing: 0.01}\n");
  const std::string shown = "splash.yaml:4:31: error: unknown key 'space.spcing'; did you mean 'spacing'?";
  EXPECT_THAT(type("check splash.yaml").err, HasSubstr(shown));
  EXPECT_THAT(read_file(std::filesystem::path(DM_SOURCE_DIR) / "docs/guide/first-film.md"), HasSubstr(shown));
}

class LedgerPage : public TypingAtADam {};

TEST_F(LedgerPage, NamesEveryColumn) {
  ASSERT_EQ(type("run dam.yaml --frames 1").code, 0);
  const std::string page = read_file(std::filesystem::path(DM_SOURCE_DIR) / "docs/reference/ledger.md");
  std::istringstream columns(read_file(folder / "out/dam/ledger.csv"));
  std::string head, column;
  std::getline(columns, head);
  std::istringstream names(head);
  int named = 0;
  while (std::getline(names, column, ',')) {
    ++named;
    // Vectors stand there once, with or without their first axis.
    if (column.size() > 2 && column[column.size() - 2] == '_' && column.back() >= 'x') column.resize(column.size() - 2);
    EXPECT_TRUE(page.find("`" + column + "`") != std::string::npos ||
                page.find("`" + column + "_x`") != std::string::npos)
        << column;
  }
  EXPECT_GT(named, 50);
}

}  // namespace
}  // namespace dreampm::test
