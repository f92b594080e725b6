// Every page: its commands are of verbs and options that there are, its scenes of keys that there
// are.
#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <regex>

#include "fences.h"
#include "typed.h"

namespace dreampm::test {
namespace {
namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

class Pages : public Typing {
 protected:
  /// The README and what docs/ has, without the notes, which say what was true at their time.
  static std::vector<fs::path> pages() {
    std::vector<fs::path> list{fs::path(DM_SOURCE_DIR) / "README.md"};
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(DM_SOURCE_DIR) / "docs"))
      if (entry.path().extension() == ".md" && entry.path().parent_path().filename() != "notes")
        list.push_back(entry.path());
    std::sort(list.begin(), list.end());
    return list;
  }
  /// Returns the output of `dreampm VERB --help`; of a verb with verbs of its own also the output
  /// of each of them.
  const std::string& help_of(const std::string& verb) {
    const auto [it, is_new] = helps.try_emplace(verb);
    if (!is_new) return it->second;
    const Typed t = type(verb + " --help");
    EXPECT_EQ(t.code, 0) << t.err;
    it->second = t.out;
    const std::size_t list = t.out.find("Subcommands:");
    if (list == std::string::npos) return it->second;
    const std::regex line("\n  ([a-z]+) ");
    const std::string below = t.out.substr(list);
    for (std::sregex_iterator m(below.begin(), below.end(), line), end; m != end; ++m)
      it->second += type(verb + " " + m->str(1) + " --help").out;
    return it->second;
  }
  std::map<std::string, std::string> helps;
};

TEST_F(Pages, TypeVerbsAndOptionsThatThereAre) {
  const std::regex command("(?:^|[ /])dreampm ([a-z]+)([^|;&#]*)"), option(" (--[a-z-]+)");
  int commands = 0;
  for (const fs::path& page : pages())
    for (const Fence& fence : fences_of(read_file(page))) {
      if (fence.language != "sh") continue;
      SCOPED_TRACE(page.string());
      std::istringstream lines(fence.text);
      for (std::string line; std::getline(lines, line);)
        for (std::sregex_iterator m(line.begin(), line.end(), command), end; m != end; ++m) {
          ++commands;
          const std::string help = help_of(m->str(1)), words = m->str(2);
          for (std::sregex_iterator o(words.begin(), words.end(), option), last; o != last; ++o)
            EXPECT_THAT(help, HasSubstr(o->str(1))) << line;
        }
    }
  EXPECT_GT(commands, 50);
}

TEST_F(Pages, NameScenesThatThereAre) {
  const std::regex scene("[ (`]scenes/[a-z/-]+\\.yaml");
  int names = 0;
  for (const fs::path& page : pages()) {
    const std::string text = read_file(page);
    for (std::sregex_iterator m(text.begin(), text.end(), scene), end; m != end; ++m, ++names)
      EXPECT_TRUE(fs::exists(fs::path(DM_SOURCE_DIR) / m->str().substr(1))) << page << ": " << m->str();
  }
  EXPECT_GT(names, 10);
}

/// Returns a part of a scene completed to a whole one; names that it uses may still be missing.
std::string completed(const std::string& part) {
  const std::pair<const char*, const char*> sections[] = {
      {"dreampm:", "dreampm: 1"},
      {"name:", "name: part"},
      {"space:", "space: {max: [1, 1, 1], spacing: 0.1}"},
      {"time:", "time: {frames: 2}"},
      {"materials:", "materials: {water: {type: newtonian, preset: water}}"},
      {"bodies:", "bodies: {pool: {material: water, shape: {box: {min: [0, 0, 0], max: [0.3, 0.3, 0.3]}}}}"}};
  if (part.starts_with("dreampm:") || part.find("\ndreampm:") != std::string::npos) return part;
  std::string whole;
  for (const auto& [key, section] : sections)
    if (!part.starts_with(key) && part.find(std::string("\n") + key) == std::string::npos)
      whole += std::string(section) + "\n";
  return whole + part;
}

TEST_F(Pages, ShowKeysThatThereAre) {
  int parts = 0;
  for (const fs::path& page : pages())
    for (const Fence& fence : fences_of(read_file(page))) {
      if (fence.language != "yaml") continue;
      ++parts;
      // All unknown keys are named at once, this one too, and then nothing is computed.
      write("part.yaml", completed(fence.text) + "no_such_key: 1\n");
      std::string errors = type("check part.yaml").err;
      const std::string own = "unknown key 'no_such_key'";
      ASSERT_THAT(errors, HasSubstr(own)) << page << "\n" << fence.text;
      errors.erase(errors.find(own), own.size());
      EXPECT_THAT(errors, Not(HasSubstr("unknown key"))) << page << "\n" << fence.text;
    }
  EXPECT_GT(parts, 20);
}

}  // namespace
}  // namespace dreampm::test
