// How many places of the code know one of a kind: who adds another one goes there and nowhere else.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cctype>
#include <filesystem>
#include <map>
#include <set>

#include "dreampm/base/file.h"

namespace dreampm {
namespace {
namespace fs = std::filesystem;
using testing::UnorderedElementsAre;

/// The files of the command and the library, with those of their build.
class Places : public testing::Test {
 protected:
  Places() {
    for (const char* folder : {"cli", "src", "cmake", "python/src"})
      for (const auto& entry : fs::recursive_directory_iterator(source / folder))
        if (entry.is_regular_file()) texts_[fs::relative(entry.path(), source).string()] = read_file(entry.path());
  }
  /// Returns the files that have one of the words.
  std::set<std::string> of(const std::vector<std::string>& words) const {
    std::set<std::string> found;
    for (const auto& [file, text] : texts_)
      for (const std::string& word : words)
        if (has(text, word)) found.insert(file);
    return found;
  }
  /// The rows of a list of macros in a file.
  std::vector<std::string> rows(const std::string& file, const std::string& row) const {
    const std::string& text = texts_.at(file);
    std::vector<std::string> names;
    for (std::size_t at = 0; (at = text.find(row + "(", at)) != std::string::npos;) {
      at += row.size() + 1;
      const std::string name = text.substr(at, text.find(')', at) - at);
      if (std::islower(static_cast<unsigned char>(name[0]))) names.push_back(name);
    }
    return names;
  }

 private:
  static bool has(const std::string& text, const std::string& word) {
    const auto joins = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
    for (std::size_t at = 0; (at = text.find(word, at)) != std::string::npos; ++at)
      if ((at == 0 || !joins(text[at - 1])) && !joins(text[at + word.size()])) return true;
    return false;
  }
  const fs::path source = DM_SOURCE_DIR;
  std::map<std::string, std::string> texts_;
};

TEST_F(Places, AVerbIsAFileAndARow) {
  const std::vector<std::string> verbs = rows("cli/verbs.h", "VERB");
  EXPECT_GE(verbs.size(), 17u);
  for (const std::string& verb : verbs)
    EXPECT_THAT(of({"add_" + verb + "(CLI", "VERB(" + verb + ")"}),
                UnorderedElementsAre("cli/" + verb + ".cpp", "cli/verbs.h"));
  EXPECT_THAT(of({"schema.cpp"}), testing::Not(testing::Contains("cli/CMakeLists.txt")))
      << "the build finds them itself";
}

TEST_F(Places, AnExportFormatIsAFileAndARow) {
  const std::string list = "src/dreampm/export/formats.h";
  const std::vector<std::string> formats = rows(list, "FORMAT");
  EXPECT_GE(formats.size(), 6u);
  for (const std::string& format : formats) {
    const std::string own = format == "ply" || format == "obj" ? "ply_obj" : format;
    EXPECT_THAT(of({format + "_format", "FORMAT(" + format + ")"}),
                UnorderedElementsAre(list, "src/dreampm/export/" + own + ".cpp"));
  }
  EXPECT_THAT(of({"usd.cpp"}), testing::IsEmpty()) << "the build finds them itself";
}

TEST_F(Places, AColumnOfTheLedgerIsItsMemberWithARowAndItsValue) {
  for (const char* column : {"dissipated_damping", "dissipated_relaxation", "dissipated_friction"})
    EXPECT_THAT(of({column}),
                UnorderedElementsAre("src/dreampm/io/ledger_columns.h", "src/dreampm/run/ledger_row.cpp"));
}

TEST_F(Places, ASolidShapeIsAFileAndTwoRows) {
  // What Bullet has a form of is there besides, and a tool that pours a disc.
  EXPECT_THAT(of({"CylinderShape"}),
              UnorderedElementsAre("src/dreampm/geometry/solids/cylinder.cpp", "src/dreampm/geometry/solids/solid.h",
                                   "src/dreampm/scene/shapes.cpp", "src/dreampm/rigid/bullet_forms.cpp",
                                   "src/dreampm/rigid/exact_forms.h", "src/dreampm/play/tools/pour.cpp"));
}

TEST_F(Places, ALookIsAFileAndARowOfEachList) {
  for (const std::string look : {"wood", "plastic"})
    EXPECT_THAT(of({"LookType::" + look, "make_" + look, "LOOK(" + look + ")"}),
                UnorderedElementsAre("src/dreampm/scene/look.cpp", "src/dreampm/render/looks.h",
                                     "src/dreampm/render/" + look + ".cpp"));
}

}  // namespace
}  // namespace dreampm
