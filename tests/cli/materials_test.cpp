// `dreampm materials`: what the tables come to, and the page that is made of them.
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "typed.h"

namespace dreampm::test {
namespace {
using nlohmann::json;

class MaterialsVerb : public Typing {};

TEST_F(MaterialsVerb, TellsWhatAPresetComesTo) {
  const Typed t = type("materials --json");
  ASSERT_EQ(t.code, 0) << t.err;
  bool water = false, rubber = false;
  for (const json& m : json::parse(t.out)) {
    std::vector<json> kinds = m.at("presets");
    kinds.push_back(m.at("defaults"));
    for (const json& k : kinds) {
      SCOPED_TRACE(m.at("name").get<std::string>() + " " + k.at("name").get<std::string>());
      EXPECT_GT(k.at("sound_speed"), 0);
      const double dx = k.at("dt_for").at("dx"), dt = k.at("dt"), c = k.at("sound_speed");
      EXPECT_GT(dt, 0);
      EXPECT_LT(dt * c, 0.5 * dx);
      const std::string name = k.at("name");
      if (name == "water") {
        water = true;
        EXPECT_NEAR(k.at("kinematic_viscosity"), 1.0016e-3 / 998.2, 1e-12);
        EXPECT_NEAR(c, std::sqrt(2 * 9.81) / std::sqrt(0.01), 1e-9);  // max_compression of the fastest matter
        EXPECT_EQ(k.at("poissons_ratio"), 0.5);
      }
      if (name == "rubber") {
        rubber = true;
        const double e = 1.5e6, nu = 0.48, rho = 950;
        EXPECT_NEAR(c, std::sqrt(e * (1 - nu) / ((1 + nu) * (1 - 2 * nu)) / rho), 1e-9);
        EXPECT_NEAR(k.at("poissons_ratio"), nu, 1e-4);
      }
    }
  }
  EXPECT_TRUE(water && rubber);
}

TEST_F(MaterialsVerb, TheTextHasTheWordsOfWhatIsNoNumber) {
  const std::string text = type("materials").out;
  int with_words = 0;
  for (const json& m : json::parse(type("materials --json").out))
    for (const json& p : m.at("parameters")) {
      const std::string key = p.at("key"), help = p.at("help");
      std::string range;
      if (p.at("default").is_string()) {  // only words are accepted
        for (const std::string word : p.at("words")) range += (range.empty() ? "" : ", ") + word;
        ++with_words;
      } else {
        std::ostringstream numbers;
        numbers << p.at("min").get<double>() << " +" << p.at("max").get<double>();
        range = std::regex_replace(numbers.str(), std::regex("e\\+"), "e\\+");
      }
      const std::string row = "\n  " + key + " [^\n]* " + range + "  [^\n]{" + std::to_string(help.size()) + "}\n";
      EXPECT_TRUE(std::regex_search(text, std::regex(row))) << row;
    }
  EXPECT_GE(with_words, 4);
}

TEST_F(MaterialsVerb, ThePageIsWhatTheCommandPrints) {
  const Typed t = type("materials --markdown");
  ASSERT_EQ(t.code, 0) << t.err;
  EXPECT_EQ(t.out, read_file(std::filesystem::path(DM_SOURCE_DIR) / "docs/reference/materials.md"))
      << "run: dreampm materials --markdown > docs/reference/materials.md";
  EXPECT_EQ(type("materials --markdown --json").code, 2);
}

TEST_F(MaterialsVerb, EveryPresetHasASmallPicture) {
  const std::filesystem::path shelf = std::filesystem::path(DM_SOURCE_DIR) / "docs/reference";
  const std::string page = read_file(shelf / "materials.md");
  const std::regex picture("\\(\\.\\./images/materials/[a-z_-]+\\.jpg\\)");
  int pictures = 0;
  for (std::sregex_iterator m(page.begin(), page.end(), picture), end; m != end; ++m, ++pictures) {
    const std::string name = m->str().substr(1, m->length() - 2);
    ASSERT_TRUE(std::filesystem::exists(shelf / name)) << name << ": run tools/material_pictures";
    const std::string bytes = read_file(shelf / name);
    EXPECT_EQ(bytes.substr(0, 3), "\xff\xd8\xff") << name << " is no JPEG";
    EXPECT_LE(bytes.size(), 60 * 1024u) << name;
  }
  int presets = 0;
  for (const json& m : json::parse(type("materials --json").out))
    presets += std::max(1, static_cast<int>(m.at("presets").size()));
  EXPECT_EQ(pictures, presets);
}

}  // namespace
}  // namespace dreampm::test
