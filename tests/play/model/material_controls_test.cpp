// Controls of materials, without a playground: what the tables of parameters say is what they are.
#include "dreampm/play/model/material_controls.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "dreampm/physics/param.h"
#include "dreampm/play/model/controls.h"
#include "dreampm/play/model/facts.h"
#include "play/small_scene.h"

namespace dreampm::play::material_controls_test {
namespace {
using namespace test;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

class MaterialControls : public testing::Test {
 protected:
  const ControlInfo& control(const std::string& id) { return find_control(controls, id); }
  PlayScene scene = small_scene();
  Simulation simulation{scene.scene, quiet_options().simulation};
  Looks looks;
  std::vector<ControlInfo> controls = material_controls(scene, simulation, looks);
};

TEST_F(MaterialControls, CoverWhatTheTableSays) {
  const ControlInfo& viscosity = control("material.water.viscosity");
  const Slider& slider = find_material("newtonian")->find("viscosity")->slider;
  EXPECT_EQ(viscosity.min, slider.min);
  EXPECT_EQ(viscosity.max, slider.max);
  EXPECT_TRUE(viscosity.decades);
  EXPECT_FALSE(viscosity.advanced);
  EXPECT_TRUE(control("material.water.relaxation").advanced);
  EXPECT_EQ(control("material.jelly.youngs_modulus").label, "Young's modulus");
  // Without a range of its own: three decades about the value of the scene.
  EXPECT_DOUBLE_EQ(control("material.jelly.youngs_modulus").min, 10);
  EXPECT_DOUBLE_EQ(control("material.jelly.youngs_modulus").max, 1e7);
}

TEST_F(MaterialControls, OfColorsSetTheLookAndNothingElse) {
  float* const opacity = look_member(looks, "material.jelly.opacity");
  ASSERT_NE(opacity, nullptr);
  *opacity = 0.25f;
  EXPECT_EQ(material_value(control("material.jelly.opacity"), simulation, looks), 0.25);
  EXPECT_EQ(look_member(looks, "material.jelly.density"), nullptr);
  EXPECT_EQ(look_member(looks, "speed"), nullptr);
  // A control is listed anew with the look as it is set.
  material_controls(scene, simulation, looks);
  EXPECT_EQ(looks.at("jelly").opacity, 0.25f);
}

TEST_F(MaterialControls, GoToTheirTargetsByFactorsOrPartsOfTheSlider) {
  Targets targets{
      {"material.water.viscosity", 1}, {"material.jelly.poissons_ratio", 0.2}, {"material.gone.density", 1}};
  std::vector<std::string> reached;
  double before = simulation.parameter("water", "viscosity");
  const ControlInfo& ratio = control("material.jelly.poissons_ratio");
  double nu = simulation.parameter("jelly", "poissons_ratio");
  for (int n = 0; n < 100 && !targets.empty(); ++n) {
    for (std::string& name : approach_targets(simulation, controls, looks, targets)) reached.push_back(std::move(name));
    const double now = simulation.parameter("water", "viscosity"),
                 new_nu = simulation.parameter("jelly", "poissons_ratio");
    EXPECT_LE(now, 1.6 * before * (1 + 1e-12));
    EXPECT_LE(std::abs(new_nu - nu), 0.06 * (ratio.max - ratio.min) * (1 + 1e-9));
    before = now, nu = new_nu;
  }
  EXPECT_EQ(before, 1);
  EXPECT_EQ(nu, 0.2);
  EXPECT_THAT(reached, testing::UnorderedElementsAre("water", "jelly"));
}

TEST_F(MaterialControls, RefuseWhatTheyCannotBe) {
  EXPECT_THROW(find_control(controls, "material.water.density2"), InputError);
  EXPECT_THROW(check_value(control("material.water.density"), -1), InputError);
  EXPECT_THROW(check_value(control("material.water.tension"), 0.5), InputError);
  check_value(control("material.water.tension"), 1);
}

TEST(SliderTables, AreOnesThatTheirMaterialsCanHave) {
  for (const MaterialInfo& m : material_infos()) {
    EXPECT_TRUE(has_right_sliders(m.params)) << m.name;
    EXPECT_TRUE(std::any_of(m.params.begin(), m.params.end(), [](const Param& p) { return p.slider.basic; })) << m.name;
  }
  const auto one = [](const Slider& slider) {
    const Param table[] = {Param{"stiffness", "Pa", 1, 0, 10, false, ""}.shown(slider),
                           {"on", "", 0, 0, 1, false, "", flag_words, true}};
    return has_right_sliders(table);
  };
  EXPECT_TRUE(one({.min = 0, .max = 10, .needs_on = "on"}));
  EXPECT_FALSE(one({.max = 11}));
  EXPECT_FALSE(one({.min = -1}));
  EXPECT_FALSE(one({.min = 3, .max = 2}));
  EXPECT_FALSE(one({.needs_off = "of"})) << "a name that was mistyped";
  EXPECT_FALSE(one({.needs_on = "stiffness"})) << "no switch";
}

TEST_F(MaterialControls, FactsNameEachMaterialAndTheRemedyTheOneThatLimits) {
  const std::vector<std::string> lines = material_facts(simulation);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_THAT(lines[0], StartsWith("water: 998.2 kg/m^3"));
  EXPECT_THAT(lines[1], StartsWith("jelly: E 10 kPa"));
  EXPECT_THAT(remedy(simulation, "wave"), HasSubstr("softer matter"));
  EXPECT_THAT(remedy(simulation, "viscosity"), HasSubstr("a lower viscosity"));
  EXPECT_THAT(remedy(simulation, "frame"), IsEmpty());
}

TEST_F(MaterialControls, WarnsOfSoftMatterOnce) {
  // With gravity at what it is reset to.
  controls = list_controls(scene, simulation, looks);
  std::vector<double> before, soft;
  for (const ControlInfo& c : controls) {
    before.push_back(material_value(c, simulation, looks));
    soft.push_back(c.id == "material.jelly.youngs_modulus" ? 10 : before.back());
  }
  EXPECT_THAT(softness_warning(simulation, controls, before, soft), StartsWith("jelly is so soft"));
  EXPECT_EQ(softness_warning(simulation, controls, soft, soft), "");
  EXPECT_EQ(softness_warning(simulation, controls, soft, before), "");
}

}  // namespace
}  // namespace dreampm::play::material_controls_test
