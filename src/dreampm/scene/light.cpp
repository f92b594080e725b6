// light, stage: what shines on the matter, and what stands around it.
#include "dreampm/scene/sections.h"

namespace dreampm::scene {
namespace {

bool has_environment(const Light& l) { return !l.environment.empty(); }

Field<Light> environment() {
  return Field<Light>{"environment",
                      [](Reading& in, const YamlNode& n, const std::string& path, Light& out) {
                        if (const auto name = read_text(in.problems, n, path))
                          out.environment = find_file(in, n, path, *name);
                      },
                      [](const Light& l, const std::string& k, YamlNode& map) {
                        if (has_environment(l)) map.put(k, write_text(l.environment));
                      }}
      .takes(text_info("a file"))
      .says(
          "An OpenEXR picture of all around, in place of the sky: longitude across, its middle towards +x, and "
          "latitude down.");
}

const Schema<Sun>& sun_schema() {
  static const Schema<Sun> schema{
      number("elevation", &Sun::elevation, between(2, 90, "degrees")).says("How high the sun stands."),
      number("azimuth", &Sun::azimuth, between(-360, 360, "degrees")).says("From which side it shines."),
      number("angle", &Sun::angle, between(0.1, 20, "degrees")).says("The radius of its disc; larger: softer shadows."),
      number("strength", &Sun::strength, between(0, 1000))
          .no_default()
          .says("The irradiance of a plane that faces it, where the sky has about 1; 0: no sun. Absent: 8 under a "
                "clear sky."),
  };
  return schema;
}

const Schema<Light>& light_schema() {
  static const Schema<Light> schema{
      written_when<Light>(choice("sky", &Light::sky, {"clear", "studio", "night"}).no_default(),
                          [](const Light& l) { return !has_environment(l); })
          .says("A clear sky, soft boxes in a gray room, or darkness; absent: that of `stage.place`."),
      environment(),
      number("turn", &Light::turn, between(-360, 360, "degrees"))
          .when(has_environment, "a light with an environment")
          .says("How far the environment is turned, by the right hand about +y."),
      number("strength", &Light::strength, between(1e-6, 1e6))
          .when(has_environment, "a light with an environment")
          .says("By what the environment's radiance is multiplied."),
      section("sun", &Light::sun, sun_schema()).says("The sun; absent with an environment, in a studio and at night.")};
  return schema;
}

const Schema<SceneProps>& stage_schema() {
  static const Schema<SceneProps> schema{
      choice("place", &SceneProps::place, {"terrace", "studio", "night"})
          .says("Tiles under a clear sky, a paper backdrop under soft boxes, or dark tiles between lamps."),
      choice("floor", &SceneProps::floor, {"tiles", "none"})
          .says("The floor below the box: that of its place, or none."),
      choice("basin", &SceneProps::basin, {"glass", "none"}).says("Panes of glass where the box has walls.")};
  return schema;
}

}  // namespace

Field<Render> light_field() { return section("light", &Render::light, light_schema()).says("Sky and sun."); }

Field<Render> stage_field() {
  return section("stage", &Render::stage, stage_schema()).says("What stands around the matter.");
}

void finish_light(const YamlNode* render, Render& out) {
  const YamlNode* const light = find_in(render, "light");
  if (!find_in(light, "sky"))
    out.light.sky = out.stage.place == model::Place::studio  ? SkyKind::studio
                    : out.stage.place == model::Place::night ? SkyKind::night
                                                             : SkyKind::clear;
  const bool sunny = out.light.sky == SkyKind::clear && !has_environment(out.light);
  if (!sunny && !find_in(light, "sun")) out.light.sun.strength = 0;
}

}  // namespace dreampm::scene
