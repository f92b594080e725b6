// output, surface, render, video: what is kept and how it is shown.
#include "dreampm/physics/param.h"
#include "dreampm/scene/look_presets.h"
#include "dreampm/scene/sections.h"

namespace dreampm::scene {
namespace {

/// A list of words, each at most once.
template <class T, std::size_t n>
Field<T> words(std::string key, std::vector<std::string> T::* member, const std::array<const char*, n>& known) {
  const std::vector<std::string> all(known.begin(), known.end());
  return Field<T>{std::move(key),
                  [member, all](Reading& in, const YamlNode& node, const std::string& path, T& out) {
                    if (!expect_list(in.problems, node, path)) return;
                    std::vector<std::string>& list = out.*member;
                    list.clear();
                    for (std::size_t i = 0; i < node.items.size(); ++i) {
                      const auto w = read_word(in.problems, node.items[i], fmt::format("{}[{}]", path, i), all);
                      if (!w) continue;
                      if (std::find(list.begin(), list.end(), *w) != list.end())
                        in.problems.error(node.items[i].at, fmt::format("{} has '{}' twice", path, *w));
                      else
                        list.push_back(*w);
                    }
                  },
                  [member](const T& t, const std::string& k, YamlNode& map) {
                    std::vector<YamlNode> items;
                    for (const std::string& a : t.*member) items.push_back(YamlNode::scalar(a));
                    map.put(k, YamlNode::list(std::move(items)));
                  }}
      .takes(list_info(word_info(all), 0));
}

/// `vdb`, of earlier versions, is what `type: fog` is now.
Field<Surface> surface_format() {
  Field<Surface> f = choice("format", &Surface::format, {"ply", "obj"})
                         .says("The format of the meshes; `obj` is written beside `ply`.");
  f.read = [read = f.read](Reading& in, const YamlNode& n, const std::string& path, Surface& out) {
    if (n.kind == YamlNode::Kind::scalar && n.text == "vdb")
      out.type = out.type == model::SurfaceType::mesh ? model::SurfaceType::fog : out.type;
    else
      read(in, n, path, out);
  };
  return f;
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

/// A name for values that keys beside it may change. What is written are the values.
Field<Look> preset() {
  std::vector<std::string> names;
  for (const LookPreset& p : look_presets()) names.emplace_back(p.name);
  return Field<Look>{"preset",
                     [names](Reading& in, const YamlNode& n, const std::string& path, Look& out) {
                       if (const auto name = read_word(in.problems, n, path, names)) out = look_preset(*name)->look;
                     },
                     {}}
      .takes(word_info(names))
      .says("Values of known matter; keys beside it win.");
}

}  // namespace

const Schema<Look>& look_schema() {
  const auto rough = [](const Look& l) { return l.type != LookType::dielectric && l.type != LookType::spheres; };
  static const Schema<Look> schema{
      preset(),
      choice("type", &Look::type, {model::look_type_names.begin(), model::look_type_names.end()})
          .no_default()
          .says("The kind of surface; absent: `dielectric` for liquids and snow, `opaque` for all else."),
      number("ior", &Look::ior, between(1, 3))
          .when(is(LookType::dielectric), "type dielectric")
          .says("The index of refraction."),
      color("absorption", &Look::absorption, between(0, 1e6, "1/m"))
          .when(is(LookType::dielectric), "type dielectric")
          .says("Of red, green and blue light on its way through the medium."),
      color("scattering", &Look::scattering, between(0, 1e6, "1/m"))
          .when(is(LookType::dielectric), "type dielectric")
          .says("Of red, green and blue light within the medium: what makes milk white; 0: clear."),
      number("anisotropy", &Look::anisotropy, between(-0.95, 0.95))
          .when(is(LookType::dielectric), "type dielectric")
          .says("The mean cosine of scattering: above 0 forward."),
      color("color", &Look::color)
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

/// Reports a type that is not its preset's.
void check_preset(Reading& in, const YamlNode& given, const std::string& path, const Look& look) {
  const YamlNode *const preset = find_in(&given, "preset"), *const type = find_in(&given, "type");
  const LookPreset* const known = preset && type ? look_preset(preset->text) : nullptr;
  if (known && known->look.type != look.type)
    in.problems.error(type->at,
                      fmt::format("{}.type is {}, and preset {} is {}: leave out one of them", path, type->text,
                                  preset->text, model::look_type_names[static_cast<std::size_t>(known->look.type)]));
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
      nested<Output>("particles", {only_word<Output>("format", "ply").says("The format of particle files."),
                                   words("attributes", &Output::attributes, model::particle_attributes)
                                       .says("What particle files hold beside positions, identities and materials.")})
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
      number("drop_life", &Surface::drop_life, above_zero("s"))
          .says(
              "How long a drop of up to 8 particles lasts that rests on a wall or a collider, apart from other liquid: "
              "it shrinks to nothing by then, as if it dried up. Absent: it stays."),
      words("attributes", &Surface::attributes, model::surface_attributes)
          .says("What the vertices of surfaces hold beside places and normals."),
      choice("type", &Surface::type, {"mesh", "fog", "sdf"})
          .says(
              "`fog` and `sdf` write a volume for OpenVDB beside the mesh: the density that the mesh is a contour of, "
              "or the distance from the mesh."),
      surface_format(),
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
      flag("denoise", &Render::denoise)
          .says("Takes the noise that is left out, by Open Image Denoise, which is installed apart."),
      choice("format", &Render::format, {"png", "exr"})
          .says("The format of the pictures; `exr` is written beside `png`."),
      camera().says("Where the camera stands and looks."),
      light_field(),
      stage_field(),
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
  // A look whose type is given is one of that type, and not what is usual here but for its color.
  if (node.is_map() && node.find("type") && !node.find("preset")) {
    const Vec3d usual = out.color;
    out = Look{};
    out.color = usual;
  }
  read_map(in, node, path, look_schema(), out);
  check_preset(in, node, path, out);
  give_defaults(out, node);
  if (out.type == LookType::dielectric) out.color = Look{}.color;  // it has none, whatever was usual here
}

void read_looks(Reading& in, const YamlNode& root, model::Scene& scene) {
  const YamlNode *const render = root.find("render"), *const materials = root.find("materials");
  std::vector<std::string> names;
  for (const Material& m : scene.materials) {
    names.push_back(m.name);
    const YamlNode* const preset = find_in(find_in(materials, m.name), "preset");
    scene.render.looks[m.name] = default_look(m.type, preset ? preset->text : "", info_of(m).liquid);
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
