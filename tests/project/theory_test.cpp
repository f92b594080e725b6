// docs/theory/ against the tree: the files, names, constants, sources and chapters that its pages
// name are there, and every formula's file is named.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <utility>
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

const fs::path shelf = root / "docs/theory";

/// Each page by its name.
const std::map<std::string, std::string>& pages() {
  static const std::map<std::string, std::string> all = [] {
    std::map<std::string, std::string> found;
    for (const auto& entry : fs::directory_iterator(shelf))
      if (entry.path().extension() == ".md") found[entry.path().filename().string()] = text_of(entry.path());
    return found;
  }();
  return all;
}

/// All pages but the list of sources.
const std::string& text() {
  static const std::string all = [] {
    std::string joined;
    for (const auto& [name, page] : pages())
      if (name != "sources.md") joined += page;
    return joined;
  }();
  return all;
}

std::vector<std::smatch> all(const std::string& text, const std::string& pattern) {
  const std::regex re(pattern);
  return {std::sregex_iterator(text.begin(), text.end(), re), std::sregex_iterator()};
}

/// Files of modules are named without src/dreampm/.
fs::path place_of(const std::string& name) {
  const fs::path in_modules = root / "src/dreampm" / name;
  return fs::exists(in_modules) ? in_modules : root / name;
}

bool has_word(const std::string& text, const std::string& word) {
  return std::regex_search(text, std::regex("\\b" + word + "\\b"));
}

TEST(Theory, FilesAndTheNamesInThemExist) {
  int files = 0, names = 0;
  for (const auto& m : all(text(), "`((?:[a-z_0-9-]+/)+[a-z_0-9-]+\\.[a-z]+)(?::(\\w+))?`")) {
    if (m[1] == "module/file.h") continue;  // the page's own explanation
    const fs::path file = place_of(m[1]);
    ASSERT_TRUE(fs::exists(file)) << "docs/theory names " << m[1];
    ++files;
    if (!m[2].matched) continue;
    EXPECT_TRUE(has_word(text_of(file), m[2])) << "docs/theory: there is no " << m[2] << " in " << m[1];
    ++names;
  }
  EXPECT_GT(files, 60);
  EXPECT_GT(names, 50);
}

/// Every word of the sources: names, keys of scenes, words in messages.
std::set<std::string> words_of_sources() {
  std::set<std::string> words;
  for (const auto& entry : fs::recursive_directory_iterator(root / "src/dreampm")) {
    if (!entry.is_regular_file()) continue;
    std::string word;
    for (const char c : text_of(entry.path()) + " ")
      if (std::isalnum(static_cast<unsigned char>(c)) || c == '_')
        word += c;
      else if (!word.empty())
        words.insert(std::exchange(word, {}));
  }
  return words;
}

TEST(Theory, NamesAloneExist) {
  const std::set<std::string> words = words_of_sources();
  int names = 0;
  for (const auto& m : all(text(), "`([A-Za-z_]+)`")) {
    EXPECT_TRUE(words.contains(m[1])) << "docs/theory: there is no " << m[1] << " in src/dreampm";
    ++names;
  }
  EXPECT_GT(names, 40);
}

TEST(Theory, ItsConstantsAreTheCodes) {
  std::string code;
  for (const char* module : {"physics", "contact", "backend", "solver", "state", "surface"})
    for (const auto& entry : fs::recursive_directory_iterator(root / "src/dreampm" / module))
      if (entry.is_regular_file()) code += text_of(entry.path());
  int constants = 0;
  for (const auto& m : all(text(), "`(\\w+)` =\\s(-?[0-9][0-9.e-]*[0-9]|[0-9])")) {
    std::smatch found;
    ASSERT_TRUE(std::regex_search(code, found, std::regex("\\b" + m[1].str() + "\\s*=\\s*([-+0-9.e]+)")))
        << m[1] << " is no constant of the code";
    EXPECT_EQ(std::stod(found[1]), std::stod(m[2])) << m[1];
    ++constants;
  }
  EXPECT_GT(constants, 20);
}

// A warning: prose follows a law that works, it does not stand in its way. Reviews read it.
TEST(Theory, LawsWithoutAPageAreReported) {
  int documented = 0;
  for (const char* folder : {"physics", "physics/materials", "physics/fields", "physics/transfers"})
    for (const auto& entry : fs::directory_iterator(root / "src/dreampm" / folder)) {
      const std::string name = std::string(folder) + "/" + entry.path().filename().string();
      const std::string code = text_of(entry.path());
      // Lists, tables of parameters and what a field is hold no formula: no function of the lane
      // type.
      if (entry.path().extension() != ".h" || code.find("DM_FN") == std::string::npos) continue;
      if (text().find("`" + name) != std::string::npos)
        ++documented;
      else
        std::printf("WARNING: docs/theory does not name %s\n", name.c_str());
    }
  EXPECT_GT(documented, 15);
}

TEST(Theory, SourcesAndCitationsMeet) {
  ASSERT_TRUE(pages().contains("sources.md"));
  std::set<std::string> cited, listed;
  for (const auto& m : all(text(), "\\[([A-Z][a-z]+[0-9]{2})\\]")) cited.insert(m[1]);
  for (const auto& m : all(pages().at("sources.md"), "\n\\| \\[([A-Z][a-z]+[0-9]{2})\\] \\|")) listed.insert(m[1]);
  EXPECT_GT(listed.size(), 15u);
  for (const std::string& name : cited) EXPECT_TRUE(listed.contains(name)) << name << " is not in the list of sources";
  for (const std::string& name : listed)
    EXPECT_TRUE(cited.contains(name)) << name << " is listed, but nothing cites it";
}

/// The anchors of a page's headings.
std::set<std::string> chapters_of(const std::string& page) {
  std::set<std::string> chapters;
  for (const auto& m : all(page, "\n#+ ([^\n]+)")) {
    std::string anchor;
    for (const char c : m[1].str())
      if (c == ' ')
        anchor += '-';
      else if (std::isalnum(static_cast<unsigned char>(c)) || c == '-')
        anchor += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    chapters.insert(anchor);
  }
  return chapters;
}

TEST(Theory, LinksAndChaptersMeet) {
  int links = 0;
  for (const auto& [name, page] : pages())
    for (const auto& m : all(page, "\\]\\(([^)#]*)(?:#([^)]+))?\\)")) {
      const fs::path file = m[1].length() ? shelf / m[1].str() : shelf / name;
      ASSERT_TRUE(fs::exists(file)) << "docs/theory/" << name << " links to " << m[1];
      ++links;
      if (!m[2].matched) continue;
      EXPECT_TRUE(chapters_of(text_of(file)).contains(m[2])) << name << ": " << file << " has no chapter #" << m[2];
    }
  EXPECT_GT(links, 20);
}

TEST(Theory, IsShort) {
  std::size_t words = 0;
  for (const auto& [name, page] : pages())
    words += all(std::regex_replace(page, std::regex("```math[^`]*```"), ""), "\\S+").size();
  // Explicit steps have 6000 words, the projection with all that lies in its liquid 1500, and
  // surfaces 800.
  EXPECT_LE(words, 8300u) << "docs/theory has the method; how it was found goes to docs/notes";
}

}  // namespace
