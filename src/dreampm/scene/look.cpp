// output, surface, render, video: what is kept and how it is shown.
#include "dreampm/physics/param.h"
#include "dreampm/scene/sections.h"

namespace dreampm::scene {
namespace {

/// A format of which there is one so far.
template <class T>
Field<T> only_word(std::string key, std::string word) {
  return Field<T>{std::move(key),
                  [=](Reading& in, const YamlNode& n, const std::string& path, T&) {
                    read_word(in.problems, n, path, std::vector<std::string>{word});
                  },
                  [=](const T&, const std::string& k, YamlNode& map) { map.put(k, YamlNode::scalar(word)); }}
      .takes(word_info({word}));
}

std::vector<std::string> attribute_words() {
  return {model::particle_attributes.begin(), model::particle_attributes.end()};
}

Field<Output> attributes() {
  return Field<Output>{"attributes",
                       [](Reading& in, const YamlNode& n, const std::string& path, Output& out) {
                         if (!expect_list(in.problems, n, path)) return;
                         const std::vector<std::string> words = attribute_words();
                         out.attributes.clear();
                         for (std::size_t i = 0; i < n.items.size(); ++i) {
                           const auto w = read_word(in.problems, n.items[i], fmt::format("{}[{}]", path, i), words);
                           if (!w) continue;
                           if (std::find(out.attributes.begin(), out.attributes.end(), *w) != out.attributes.end())
                             in.problems.error(n.items[i].at, fmt::format("{} has '{}' twice", path, *w));
                           else
                             out.attributes.push_back(*w);
                         }
                       },
                       [](const Output& o, const std::string& k, YamlNode& map) {
                         std::vector<YamlNode> items;
                         for (const std::string& a : o.attributes) items.push_back(YamlNode::scalar(a));
                         map.put(k, YamlNode::list(std::move(items)));
                       }}
      .takes(list_info(word_info(attribute_words()), 0))
      .says("What particle files hold beside positions, identities and materials.");
}

/// Even sides, because yuv420p video halves them.
Field<Render> size() {
  return Field<Render>{
      "size",
      [](Reading& in, const YamlNode& n, const std::string& path, Render& out) {
        if (n.kind != YamlNode::Kind::list || n.items.size() != 2)
          return in.problems.error(
              n.at,
              fmt::format("{} is {}: must be a list of 2 numbers, [width, height]", path,
                          n.kind == YamlNode::Kind::list ? fmt::format("a list of {}", n.items.size()) : n.describe()));
        for (std::size_t i = 0; i < 2; ++i) {
          const std::string name = fmt::format("{}[{}]", path, i);
          const auto v = read_count(in.problems, n.items[i], name, 16, 16384);
          if (v && *v % 2)
            in.problems.error(n.items[i].at,
                              fmt::format("{} is {}: must be even, for the video: {} or {}", name, *v, *v - 1, *v + 1));
          else if (v)
            (i == 0 ? out.width : out.height) = int(*v);
        }
      },
      [](const Render& r, const std::string& k, YamlNode& map) {
        map.put(k, YamlNode::list({write_count(r.width), write_count(r.height)}));
      }}
      .takes(list_info({WholeInfo{16, 16384}}, 2, 2))
      .says("Width and height of the pictures in pixels, both even.");
}

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
      later<Camera>("shutter"),
  };
  return schema;
}

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

const Schema<Sun>& sun_schema() {
  static const Schema<Sun> schema{
      number("elevation", &Sun::elevation, between(2, 90, "degrees")).says("How high the sun stands."),
      number("azimuth", &Sun::azimuth, between(-360, 360, "degrees")).says("From which side it shines."),
      number("angle", &Sun::angle, between(0.1, 20, "degrees")).says("The radius of its disc; larger: softer shadows."),
      number("strength", &Sun::strength, between(0, 1000))
          .says("The irradiance of a plane that faces it, where the sky has about 1; 0: no sun."),
  };
  return schema;
}

const Schema<Light>& light_schema() {
  static const Schema<Light> schema{
      choice("sky", &Light::sky, {"clear", "studio"}).says("A clear sky, or the even light of a studio."),
      section("sun", &Light::sun, sun_schema()).says("The sun.")};
  return schema;
}

const Schema<SceneProps>& stage_schema() {
  static const Schema<SceneProps> schema{
      choice("floor", &SceneProps::floor, {"tiles", "none"}).says("The floor below the box."),
      choice("basin", &SceneProps::basin, {"glass", "none"}).says("Panes of glass where the box has walls.")};
  return schema;
}

std::function<bool(const Look&)> is(LookType t) {
  return [t](const Look& l) { return l.type == t; };
}

Field<Look> grain() {
  Field<Look> f = vector("grain", &Look::grain)
                      .says(
                          "The direction of the fibers of wood, for the body as it stands in the scene; absent: its "
                          "longest side.");
  f.read = [read = f.read](Reading& in, const YamlNode& n, const std::string& path, Look& out) {
    read(in, n, path, out);
    if (out.grain && !(length(*out.grain) > 0))
      in.problems.error(n.at, fmt::format("{} is [0, 0, 0]: must have a direction", path));
  };
  return f;
}

}  // namespace

const Schema<Look>& look_schema() {
  const auto rough = [](const Look& l) { return l.type != LookType::dielectric && l.type != LookType::spheres; };
  static const Schema<Look> schema{
      choice("type", &Look::type, {"dielectric", "opaque", "spheres", "wood", "metal", "plastic"})
          .no_default()
          .says("The kind of surface; absent: `dielectric` for liquids, `opaque` for all else."),
      number("ior", &Look::ior, between(1.01, 3))
          .when(is(LookType::dielectric), "type dielectric")
          .says("The index of refraction."),
      vector("absorption", &Look::absorption, between(0, 1e6, "1/m"))
          .when(is(LookType::dielectric), "type dielectric")
          .says("Of red, green and blue light on its way through the medium."),
      vector("color", &Look::color, between(0, 1))
          .when([](const Look& l) { return l.type != LookType::dielectric; }, "types other than dielectric")
          .no_default()
          .says("In sRGB; absent: red for materials, gray for colliders, and the color of wood, steel or plastic."),
      number("roughness", &Look::roughness, between(0, 1))
          .when(rough, "type opaque, wood, metal and plastic")
          .no_default()
          .says("0 is polished; absent: 1 of opaque, 0.45 of wood, 0.3 of metal, 0.2 of plastic."),
      number("ring", &Look::ring, between(1e-5, 100, "m"))
          .when(is(LookType::wood), "type wood")
          .says("The distance from ring to ring; absent: by the size of the body."),
      grain().when(is(LookType::wood), "type wood"),
      number("radius", &Look::radius, between(0.001, 10, "spacings"))
          .when(is(LookType::spheres), "type spheres")
          .says("The radius of each particle's ball."),
  };
  return schema;
}

namespace {

/// Sets the values that a look has where the scene gives its type alone.
void give_defaults(Look& look, const YamlNode& given) {
  struct Default {
    LookType type;
    Vec3d color;
    double roughness;
  };
  static constexpr std::array<Default, 3> defaults{{{LookType::wood, {0.74, 0.54, 0.33}, 0.45},
                                                    {LookType::metal, {0.77, 0.78, 0.79}, 0.3},
                                                    {LookType::plastic, {0.62, 0.09, 0.07}, 0.2}}};
  for (const Default& d : defaults) {
    if (look.type != d.type) continue;
    if (!given.find("color")) look.color = d.color;
    if (!given.find("roughness")) look.roughness = d.roughness;
  }
}

const Schema<Cut>& cut_schema() {
  static const Schema<Cut> schema{
      vector("point", &Cut::point, any_number("m")).must().says("A point of the plane."),
      vector("normal", &Cut::normal).must().says("The side of the plane that is left out; any length above 0."),
      names_of_things("of", &Cut::of, "material, collider or rigid body").must().says("What is cut.")};
  return schema;
}

Field<Render> cut() {
  return Field<Render>{"cut",
                       [](Reading& in, const YamlNode& n, const std::string& path, Render& out) {
                         const int before = in.problems.errors();
                         read_map(in, n, path, cut_schema(), out.cut.emplace());
                         if (in.problems.errors() == before && !(length(out.cut->normal) > 0))
                           in.problems.error(n.find("normal")->at,
                                             fmt::format("{}.normal is [0, 0, 0]: must have a direction", path));
                       },
                       [](const Render& r, const std::string& k, YamlNode& map) {
                         if (r.cut) map.put(k, write_map(*r.cut, cut_schema()));
                       }}
      .takes(map_of(cut_schema()))
      .says("A plane before which some things are left out of the picture, to look inside.");
}

const Vec3d collider_gray{0.55, 0.56, 0.58};

void write_looks(const Render& r, const std::string& key, YamlNode& map) {
  YamlNode looks = YamlNode::map();
  for (const auto& [name, look] : r.looks) looks.put(name, write_map(look, look_schema()));
  map.put(key, std::move(looks));
}

/// read_looks reads it, once there are materials and colliders.
Field<Render> looks() {
  return Field<Render>{"looks", [](Reading&, const YamlNode&, const std::string&, Render&) {}, write_looks}
      .takes(names_info(map_of(look_schema())))
      .says("The looks of materials, colliders and rigid bodies, by their names.");
}

}  // namespace

const Schema<Output>& output_schema() {
  static const Schema<Output> schema{
      text("folder", &Output::folder)
          .takes(text_info("a folder"))
          .says("Where the run goes, from the working folder; absent: out/NAME, or out/NAME-VARIANT."),
      nested<Output>("particles",
                     {only_word<Output>("format", "ply").says("The format of particle files."), attributes()})
          .says("The particle files, one a frame."),
      nested<Output>("checkpoint", {count("every", &Output::checkpoint_every, 0, 1000000)
                                        .says("Frames from checkpoint to checkpoint; 0: none.")})
          .says("From where an interrupted run goes on."),
  };
  return schema;
}

const Schema<Surface>& surface_schema() {
  static const Schema<Surface> schema{
      number("voxel", &Surface::voxel, between(0.1, 2, "dx")).says("The resolution of the surface."),
      count("smooth", &Surface::smooth, 0, 10).says("Rounds of smoothing."),
      number("overlap", &Surface::overlap, between(0, 1, "spacings"))
          .says("How far it reaches into walls and colliders that it touches, so that no film of air is left."),
      choice("format", &Surface::format, {"ply", "obj", "vdb"})
          .says("The format of the surfaces; `obj` and `vdb` are written beside `ply`."),
  };
  return schema;
}

const Schema<Render>& render_schema() {
  static const Schema<Render> schema{
      size(),
      count("samples", &Render::samples, 4, 65536).says("The most paths of light a pixel."),
      number("noise", &Render::noise, between(1e-6, 1)).says("The error of a pixel at which its sampling stops."),
      flag("caustics", &Render::caustics).says("Whether sunlight reaches the floor refracted."),
      flag("physical", &Render::physical).says("Leaves out what is only look: the glow of deep water, a dimmed sun."),
      camera().says("Where the camera stands and looks."),
      section("light", &Render::light, light_schema()).says("Sky and sun."),
      section("stage", &Render::stage, stage_schema()).says("What stands around the matter."),
      cut(),
      looks(),
  };
  return schema;
}

const Schema<Video>& video_schema() {
  static const Schema<Video> schema{
      count("quality", &Video::quality, 0, 51).says("The rate factor of x264: 0 is best, 51 worst.")};
  return schema;
}

void read_look(Reading& in, const YamlNode& node, const std::string& path, Look& out) {
  read_map(in, node, path, look_schema(), out);
  give_defaults(out, node);
  if (out.type == LookType::dielectric) out.color = Look{}.color;  // it has none, whatever was usual here
}

void read_looks(Reading& in, const YamlNode* render, model::Scene& scene) {
  std::vector<std::string> names;
  for (const Material& m : scene.materials) {
    names.push_back(m.name);
    Look look;
    look.type = !info_of(m).liquid ? LookType::opaque : LookType::dielectric;
    scene.render.looks[m.name] = look;
  }
  for (const Collider& c : scene.colliders) {
    if (scene.render.looks.contains(c.name)) continue;  // reported with the colliders
    names.push_back(c.name);
    Look look;
    look.type = LookType::opaque;
    look.color = collider_gray;
    scene.render.looks[c.name] = look;
  }
  if (!render || !render->is_map()) return;
  if (const YamlNode* cut = render->find("cut"); cut && cut->is_map())
    if (const YamlNode* of = cut->find("of"); of && of->kind == YamlNode::Kind::list)
      for (const YamlNode& n : of->items)
        if (!n.text.empty() && !scene.render.looks.contains(n.text))
          in.problems.error(n.at, fmt::format("render.cut.of: no material, collider or rigid body '{}'{}", n.text,
                                              suggest(n.text, names)));
  const YamlNode* node = render->find("looks");
  if (!node) return;
  read_named(in, *node, "render.looks", [&](const Entry& e, const std::string& path) {
    const auto found = scene.render.looks.find(e.key);
    if (found == scene.render.looks.end())
      return in.problems.error(
          e.at, fmt::format("{}: no material, collider or rigid body '{}'{}", path, e.key, suggest(e.key, names)));
    Look& look = found->second;
    read_look(in, e.value, path, look);
    const bool collider =
        std::any_of(scene.colliders.begin(), scene.colliders.end(), [&](const Collider& c) { return c.name == e.key; });
    if (collider && look.type == LookType::spheres)
      in.problems.error(
          e.at, fmt::format("{}: a collider has no particles: dielectric, opaque, wood, metal or plastic", path));
    if (!collider && look.type == LookType::wood)
      in.problems.error(e.at, fmt::format("{}: wood is for colliders and rigid bodies: the grain of a material would "
                                          "not move with it; opaque, metal or plastic",
                                          path));
  });
}

}  // namespace dreampm::scene
