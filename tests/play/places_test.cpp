// In how many places things of the playground stand: a tool is its file and a word in the list
// of tools, and so is a panel.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <regex>
#include <string>
#include <vector>

#include "dreampm/base/file.h"
#include "dreampm/play/panels/key_help.h"
#include "dreampm/play/tools/tool.h"

namespace dreampm::play::places_test {
namespace {

const std::filesystem::path source = std::filesystem::path(DM_SOURCE_DIR) / "src" / "dreampm" / "play";

/// Files of the playground, as "tools/push.cpp", in which that stands.
std::vector<std::string> files_with(const std::string& text) {
  std::vector<std::string> found;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(source))
    if (const std::string ending = entry.path().extension(); ending == ".cpp" || ending == ".h")
      if (read_file(entry.path()).find(text) != std::string::npos)
        found.push_back(std::filesystem::relative(entry.path(), source));
  return found;
}

/// The words of a list of the form `#define DM_TOOLS(tool) tool(push) tool(grab)`.
std::vector<std::string> words_of(const std::string& file, const std::string& word) {
  const std::string text = read_file(source / file);
  const std::size_t begin = text.find("#define DM_"), end = text.find("\n\n", begin);
  const std::string list = text.substr(begin, end - begin);
  const std::regex one("[ (]" + word + R"(\((\w+)\))");
  std::vector<std::string> words;
  for (std::sregex_iterator at(list.begin(), list.end(), one), none; at != none; ++at) words.push_back((*at)[1]);
  return words;
}

// Settings of tools stand with the other settings, and the bench plays as a script does.
bool may_name_tools(const std::string& file) { return file == "model/control.cpp" || file == "model/bench_play.cpp"; }

TEST(Places, AToolStandsInItsFileAlone) {
  const std::vector<std::string> list = words_of("tools/tools.cpp", "tool");
  ASSERT_EQ(list.size(), tool_infos().size());
  for (std::size_t t = 0; t < list.size(); ++t) {
    EXPECT_EQ(tool_infos()[t].name, list[t]);
    const std::vector<std::string> made = files_with(fmt::format("make_{}() {{", list[t]));
    ASSERT_EQ(made.size(), 1u) << list[t];
    if (tool_infos()[t].key == 0) continue;  // the cursor and keys go to those by themselves
    for (const std::string& file : files_with(fmt::format("\"{}\"", list[t])))
      EXPECT_TRUE(file == made[0] || may_name_tools(file)) << list[t] << " in " << file;
    for (const Verb& verb : tool_infos()[t].verbs)
      for (const std::string& file : files_with(fmt::format("\"{}\", \"", verb.name)))
        EXPECT_TRUE(file == made[0] || may_name_tools(file)) << verb.name << " in " << file;
  }
}

TEST(Places, APanelStandsInItsFileAlone) {
  const std::vector<std::string> list = words_of("panels/panels.cpp", "panel");
  EXPECT_GT(list.size(), 15u);
  for (const std::string& name : list) {
    const std::vector<std::string> made = files_with(fmt::format("make_{}_panel() {{", name));
    EXPECT_EQ(made.size(), 1u) << name;
    EXPECT_EQ(files_with(fmt::format("make_{}_panel", name)), made) << name;
  }
}

TEST(Places, AKeyStandsInOneListThatTheGuidePrints) {
  std::map<char, std::string> tools;
  for (const ToolInfo& tool : tool_infos())
    for (const char key : {tool.key, tool.held_key})
      EXPECT_TRUE(key == 0 || tools.emplace(key, tool.name).second) << key;
  std::string rows;
  for (const KeyHelp& row : key_help()) rows += row.row + "\n";
  for (const auto& [key, name] : tools) EXPECT_NE(rows.find(fmt::format("`{}`", key)), std::string::npos) << name;
  const std::string guide = read_file(std::filesystem::path(DM_SOURCE_DIR) / "docs" / "guide" / "playground.md");
  const std::string head = "| keys | what they do |\n|---|---|\n";
  const std::size_t begin = guide.find(head);
  ASSERT_NE(begin, std::string::npos);
  const std::size_t from = begin + head.size();
  EXPECT_EQ(guide.substr(from, guide.find("\n\n", from) + 1 - from), rows) << "docs/guide/playground.md";
}

}  // namespace
}  // namespace dreampm::play::places_test
