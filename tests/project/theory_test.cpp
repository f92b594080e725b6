// docs/theory.md against the tree: the files, names, constants, sources and chapters that it names
// are there, and every formula's file is named.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace {
namespace fs = std::filesystem;

const fs::path root = DM_SOURCE_DIR;

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

const std::string& page() {
  static const std::string text = text_of(root / "docs/theory.md");
  return text;
}

std::vector<std::smatch> all(const std::string& text, const std::string& pattern) {
  const std::regex re(pattern);
  return {std::sregex_iterator(text.begin(), text.end(), re), std::sregex_iterator()};
}

/// Files of modules are named without src/dreampm/.
fs::path place_of(const std::string& name) {
  const fs::path in_rooms = root / "src/dreampm" / name;
  return fs::exists(in_rooms) ? in_rooms : root / name;
}

bool has_word(const std::string& text, const std::string& word) {
  return std::regex_search(text, std::regex("\\b" + word + "\\b"));
}

TEST(Theory, FilesAndTheNamesInThemExist) {
  int files = 0, names = 0;
  for (const auto& m : all(page(), "`((?:[a-z_0-9-]+/)+[a-z_0-9-]+\\.[a-z]+)(?::(\\w+))?`")) {
    if (m[1] == "module/file.h") continue;  // the page's own explanation
    const fs::path file = place_of(m[1]);
    ASSERT_TRUE(fs::exists(file)) << "docs/theory.md names " << m[1];
    ++files;
    if (!m[2].matched) continue;
    EXPECT_TRUE(has_word(text_of(file), m[2])) << "docs/theory.md: there is no " << m[2] << " in " << m[1];
    ++names;
  }
  EXPECT_GT(files, 60);
  EXPECT_GT(names, 50);
}

TEST(Theory, ItsConstantsAreTheCodes) {
  std::string code;
  for (const char* module : {"physics", "backend", "solver", "state"})
    for (const auto& entry : fs::recursive_directory_iterator(root / "src/dreampm" / module))
      if (entry.is_regular_file()) code += text_of(entry.path());
  int constants = 0;
  for (const auto& m : all(page(), "`(\\w+)` = (-?[0-9][0-9.e-]*[0-9]|[0-9])")) {
    std::smatch found;
    ASSERT_TRUE(std::regex_search(code, found, std::regex("\\b" + m[1].str() + "\\s*=\\s*([-+0-9.e]+)")))
        << m[1] << " is no constant of the code";
    EXPECT_EQ(std::stod(found[1]), std::stod(m[2])) << m[1];
    ++constants;
  }
  EXPECT_GT(constants, 8);
}

TEST(Theory, EveryLawIsDocumented) {
  for (const char* folder : {"physics", "physics/materials", "physics/fields", "physics/transfers"})
    for (const auto& entry : fs::directory_iterator(root / "src/dreampm" / folder)) {
      const std::string name = std::string(folder) + "/" + entry.path().filename().string();
      const std::string code = text_of(entry.path());
      // Lists, tables of parameters and what a field is hold no formula: no function of the lane
      // type.
      if (entry.path().extension() != ".h" || code.find("DM_FN") == std::string::npos) continue;
      EXPECT_NE(page().find("`" + name), std::string::npos) << "docs/theory.md does not tell of " << name;
    }
}

TEST(Theory, SourcesAndChaptersMeet) {
  std::set<std::string> cited, listed, chapters;
  for (const auto& m : all(page(), "\\[([A-Z][a-z]+[0-9]{2})\\]")) cited.insert(m[1]);
  for (const auto& m : all(page(), "\n\\| \\[([A-Z][a-z]+[0-9]{2})\\] \\|")) listed.insert(m[1]);
  EXPECT_GT(listed.size(), 15u);
  const std::size_t list = page().find("\n## Sources");
  ASSERT_NE(list, std::string::npos);
  for (const std::string& name : cited) EXPECT_TRUE(listed.contains(name)) << name << " is not in the list of sources";
  for (const std::string& name : listed)
    EXPECT_LT(page().find("[" + name + "]"), list) << name << " is listed, but nothing cites it";

  for (const auto& m : all(page(), "\n#+ ([^\n]+)")) {
    std::string anchor;
    for (const char c : m[1].str())
      if (c == ' ')
        anchor += '-';
      else if (std::isalnum(static_cast<unsigned char>(c)) || c == '-')
        anchor += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    chapters.insert(anchor);
  }
  for (const auto& m : all(page(), "\\]\\(#([^)]+)\\)"))
    EXPECT_TRUE(chapters.contains(m[1])) << "docs/theory.md has no chapter #" << m[1];
  for (const auto& m : all(page(), "\\]\\(([^)#]+)\\)"))
    EXPECT_TRUE(fs::exists(root / "docs" / m[1].str())) << "docs/theory.md links to " << m[1];
}

}  // namespace
