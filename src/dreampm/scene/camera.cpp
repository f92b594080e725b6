// render.camera: where the camera stands, its lens and its exposure.
#include "dreampm/scene/sections.h"

namespace dreampm::scene {
namespace {

bool fitted(const Camera& c) { return c.fit_basin; }
bool aimed(const Camera& c) { return !c.fit_basin; }

Field<Camera> camera_from() {
  Field<Camera> f = vector("from", &Camera::from, any_number("m")).no_default();
  f.read = [read = f.read](Reading& in, const YamlNode& n, const std::string& path, Camera& out) {
    out.fit_basin = false;
    read(in, n, path, out);
  };
  return f;
}

/// A distance or a point.
Field<Camera> focus() {
  const Range range = between(1e-6, 1e9, "m");
  return Field<Camera>{"focus",
                       [range](Reading& in, const YamlNode& n, const std::string& path, Camera& out) {
                         out.focus.reset(), out.focus_point.reset();
                         if (n.kind == YamlNode::Kind::list)
                           out.focus_point = read_vector(in.problems, n, path, any_number("m"));
                         else
                           out.focus = read_number(in.problems, n, path, range, "a number or a list of 3");
                       },
                       [](const Camera& c, const std::string& k, YamlNode& map) {
                         if (c.focus) map.put(k, write_number(*c.focus));
                         if (c.focus_point) map.put(k, write_vector(*c.focus_point));
                       }}
      .takes(either({number_info(range), vector_info(any_number("m"))}))
      .says(
          "What is sharp: how far the plane lies from the camera, along its line of sight, or a point of it; absent: "
          "the middle of the box, or `to`.");
}

const Schema<Camera>& camera_schema() {
  static const Schema<Camera> schema{
      written_when<Camera>(only_word<Camera>("fit", "basin"), fitted)
          .says("The camera stands so that the box of the scene fills the picture."),
      written_when<Camera>(camera_from(), aimed).says("Where the camera stands, in place of `fit`."),
      written_when<Camera>(vector("to", &Camera::to, any_number("m")).no_default(), aimed)
          .says("The point that it looks at, with `from`."),
      written_when<Camera>(number("azimuth", &Camera::azimuth, between(-360, 360, "degrees")), fitted)
          .says("From which side a fitted camera looks, about the vertical."),
      written_when<Camera>(number("elevation", &Camera::elevation, between(-89, 89, "degrees")), fitted)
          .says("How high a fitted camera stands over the horizon."),
      written_when<Camera>(number("fill", &Camera::fill, between(0.05, 2)), fitted)
          .says("The part of the picture that the box fills for a fitted camera."),
      number("fov", &Camera::fov, between(1, 150, "degrees")).says("The vertical angle of view."),
      number("shutter", &Camera::shutter, between(0, 1))
          .says("The part of the time from frame to frame for which a picture is exposed; what moves is blurred."),
      written_when<Camera>(number("aperture", &Camera::aperture, between(0, 1e3, "m")),
                           [](const Camera& c) { return !c.fstop; })
          .says("The diameter of the lens; 0: a pinhole, in which all is sharp."),
      number("fstop", &Camera::fstop, between(0.1, 1e6))
          .says("The f-number of the lens in place of its diameter, of film 24 mm high."),
      focus(),
  };
  return schema;
}

}  // namespace

Field<Render> camera() {
  Field<Render> f = section("camera", &Render::camera, camera_schema());
  f.value = map_of([] {
    MapInfo info{keys_info(camera_schema())};
    info.together = {"from", "to"};
    return info;
  });
  f.read = [read = f.read](Reading& in, const YamlNode& n, const std::string& path, Render& out) {
    const int before = in.problems.errors();
    read(in, n, path, out);
    if (in.problems.errors() > before) return;
    const YamlNode *from = n.find("from"), *to = n.find("to");
    if (!from != !to)
      in.problems.error(n.at, fmt::format("{0} has '{1}' without '{2}': give both", path, from ? "from" : "to",
                                          from ? "to" : "from"));
    else if (from && out.camera.from == out.camera.to)
      in.problems.error(to->at, fmt::format("{0}.to is the same point as {0}.from: nothing to look along", path));
  };
  return f;
}

void check_shutter(Reading& in, const YamlNode* render, const model::Scene& scene) {
  if (!(scene.render.camera.shutter > 0)) return;
  const std::vector<std::string>& kept = scene.output.attributes;
  if (std::find(kept.begin(), kept.end(), "velocity") != kept.end()) return;
  const YamlNode* shutter = find_in(find_in(render, "camera"), "shutter");
  in.problems.error(shutter ? shutter->at : Place{},
                    fmt::format("render.camera.shutter is {}: blur needs velocity in output.particles.attributes",
                                scene.render.camera.shutter));
}

}  // namespace dreampm::scene
