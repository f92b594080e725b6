// output, surface, render, video: what is kept and how it is shown.
#include "dreampm/scene/sections.h"

namespace dreampm::scene {
namespace {

/// A format of which there is one so far.
template <class T>
Field<T> only_word(std::string key, std::string word) {
  return {std::move(key),
          [=](Reading& in, const YamlNode& n, const std::string& path, T&) {
            read_word(in.problems, n, path, std::vector<std::string>{word});
          },
          [=](const T&, const std::string& k, YamlNode& map) { map.put(k, YamlNode::scalar(word)); }};
}

Field<Output> attributes() {
  return {"attributes",
          [](Reading& in, const YamlNode& n, const std::string& path, Output& out) {
            if (!expect_list(in.problems, n, path)) return;
            const std::vector<std::string> words(particle_attributes.begin(), particle_attributes.end());
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
          }};
}

/// Even sides, because yuv420p video halves them.
Field<Render> size() {
  return {"size",
          [](Reading& in, const YamlNode& n, const std::string& path, Render& out) {
            if (n.kind != YamlNode::Kind::list || n.items.size() != 2)
              return in.problems.error(
                  n.at, fmt::format("{} is {}: must be a list of 2 numbers, [width, height]", path,
                                    n.kind == YamlNode::Kind::list ? fmt::format("a list of {}", n.items.size())
                                                                   : n.describe()));
            for (std::size_t i = 0; i < 2; ++i) {
              const std::string name = fmt::format("{}[{}]", path, i);
              const auto v = read_count(in.problems, n.items[i], name, 16, 16384);
              if (v && *v % 2)
                in.problems.error(n.items[i].at, fmt::format("{} is {}: must be even, for the video: {} or {}", name,
                                                             *v, *v - 1, *v + 1));
              else if (v)
                (i == 0 ? out.width : out.height) = int(*v);
            }
          },
          [](const Render& r, const std::string& k, YamlNode& map) {
            map.put(k, YamlNode::list({write_count(r.width), write_count(r.height)}));
          }};
}

bool fitted(const Camera& c) { return c.fit_basin; }
bool aimed(const Camera& c) { return !c.fit_basin; }

Field<Camera> camera_from() {
  Field<Camera> f = vector("from", &Camera::from);
  f.read = [read = f.read](Reading& in, const YamlNode& n, const std::string& path, Camera& out) {
    out.fit_basin = false;
    read(in, n, path, out);
  };
  return f;
}

const Schema<Camera>& camera_schema() {
  static const Schema<Camera> schema{
      written_when<Camera>(only_word<Camera>("fit", "basin"), fitted),
      written_when<Camera>(camera_from(), aimed),
      written_when<Camera>(vector("to", &Camera::to), aimed),
      written_when<Camera>(number("azimuth", &Camera::azimuth, between(-360, 360, "degrees")), fitted),
      written_when<Camera>(number("elevation", &Camera::elevation, between(-89, 89, "degrees")), fitted),
      written_when<Camera>(number("fill", &Camera::fill, between(0.05, 2)), fitted),
      number("fov", &Camera::fov, between(1, 150, "degrees")),
      later<Camera>("shutter"),
  };
  return schema;
}

Field<Render> camera() {
  Field<Render> f = section("camera", &Render::camera, camera_schema());
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
      number("elevation", &Sun::elevation, between(2, 90, "degrees")),
      number("azimuth", &Sun::azimuth, between(-360, 360, "degrees")),
      number("angle", &Sun::angle, between(0.1, 20, "degrees")),
      number("strength", &Sun::strength, between(0, 1000)),
  };
  return schema;
}

const Schema<Light>& light_schema() {
  static const Schema<Light> schema{choice("sky", &Light::sky, {"clear", "studio"}),
                                    section("sun", &Light::sun, sun_schema())};
  return schema;
}

const Schema<SceneProps>& stage_schema() {
  static const Schema<SceneProps> schema{choice("floor", &SceneProps::floor, {"tiles", "none"}),
                                         choice("basin", &SceneProps::basin, {"glass", "none"})};
  return schema;
}

std::function<bool(const Look&)> is(LookType t) {
  return [t](const Look& l) { return l.type == t; };
}

const Schema<Look>& look_schema() {
  static const Schema<Look> schema{
      choice("type", &Look::type, {"dielectric", "opaque", "spheres"}),
      number("ior", &Look::ior, between(1.01, 3)).when(is(LookType::dielectric), "type dielectric"),
      vector("absorption", &Look::absorption, between(0, 1e6, "1/m")).when(is(LookType::dielectric), "type dielectric"),
      vector("color", &Look::color, between(0, 1))
          .when([](const Look& l) { return l.type != LookType::dielectric; }, "type opaque and spheres"),
      number("roughness", &Look::roughness, between(0, 1)).when(is(LookType::opaque), "type opaque"),
      number("radius", &Look::radius, between(0.001, 10, "spacings")).when(is(LookType::spheres), "type spheres"),
  };
  return schema;
}

const Vec3d collider_grey{0.55, 0.56, 0.58};

void write_looks(const Render& r, const std::string& key, YamlNode& map) {
  YamlNode looks = YamlNode::map();
  for (const auto& [name, look] : r.looks) looks.put(name, write_map(look, look_schema()));
  map.put(key, std::move(looks));
}

}  // namespace

const Schema<Output>& output_schema() {
  static const Schema<Output> schema{
      text("folder", &Output::folder),
      nested<Output>("particles", {only_word<Output>("format", "ply"), attributes()}),
      nested<Output>("checkpoint", {count("every", &Output::checkpoint_every, 0, 1000000)}),
  };
  return schema;
}

const Schema<Surface>& surface_schema() {
  static const Schema<Surface> schema{
      number("voxel", &Surface::voxel, between(0.1, 2, "dx")),
      count("smooth", &Surface::smooth, 0, 10),
      choice("format", &Surface::format, {"ply", "obj", "vdb"}),
  };
  return schema;
}

const Schema<Render>& render_schema() {
  static const Schema<Render> schema{
      size(),
      count("samples", &Render::samples, 4, 65536),
      number("noise", &Render::noise, between(1e-6, 1)),
      flag("caustics", &Render::caustics),
      flag("physical", &Render::physical),
      camera(),
      section("light", &Render::light, light_schema()),
      section("stage", &Render::stage, stage_schema()),
      {"looks", [](Reading&, const YamlNode&, const std::string&, Render&) {}, write_looks},  // read by read_looks
  };
  return schema;
}

const Schema<Video>& video_schema() {
  static const Schema<Video> schema{count("quality", &Video::quality, 0, 51)};
  return schema;
}

void read_looks(Reading& in, const YamlNode* node, SceneDescription& scene) {
  std::vector<std::string> names;
  for (const Material& m : scene.materials) {
    names.push_back(m.name);
    Look look;
    look.type = m.info && !m.info->liquid ? LookType::opaque : LookType::dielectric;
    scene.render.looks[m.name] = look;
  }
  for (const Collider& c : scene.colliders) {
    if (scene.render.looks.contains(c.name)) continue;  // reported with the colliders
    names.push_back(c.name);
    Look look;
    look.type = LookType::opaque;
    look.color = collider_grey;
    scene.render.looks[c.name] = look;
  }
  if (!node) return;
  read_named(in, *node, "render.looks", [&](const Entry& e, const std::string& path) {
    const auto found = scene.render.looks.find(e.key);
    if (found == scene.render.looks.end())
      return in.problems.error(e.at,
                               fmt::format("{}: no material or collider '{}'{}", path, e.key, suggest(e.key, names)));
    read_map(in, e.value, path, look_schema(), found->second);
    const bool collider =
        std::any_of(scene.colliders.begin(), scene.colliders.end(), [&](const Collider& c) { return c.name == e.key; });
    if (collider && found->second.type == LookType::spheres)
      in.problems.error(e.at, fmt::format("{}: a collider has no particles: opaque or dielectric", path));
  });
}

}  // namespace dreampm::scene
