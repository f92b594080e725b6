// `dreampm materials`: what the tables come to, and the page that is made of them.
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

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
        const double e = 1e6, nu = 0.48, rho = 1100;
        EXPECT_NEAR(c, std::sqrt(e * (1 - nu) / ((1 + nu) * (1 - 2 * nu)) / rho), 1e-9);
        EXPECT_NEAR(k.at("poissons_ratio"), nu, 1e-4);
      }
    }
  }
  EXPECT_TRUE(water && rubber);
}

TEST_F(MaterialsVerb, ThePageIsWhatTheCommandPrints) {
  const Typed t = type("materials --markdown");
  ASSERT_EQ(t.code, 0) << t.err;
  EXPECT_EQ(t.out, read_file(std::filesystem::path(DM_SOURCE_DIR) / "docs/materials.md"))
      << "run: dreampm materials --markdown > docs/materials.md";
  EXPECT_EQ(type("materials --markdown --json").code, 2);
}

}  // namespace
}  // namespace dreampm::test
