// The tables of a scene's sections. What stands in more than one file of this folder is declared
// here.
#pragma once
#include "dreampm/model/scene.h"
#include "dreampm/scene/fields.h"

namespace dreampm::scene {

// The structs of the model, which the tables are of.
using model::Basin;
using model::Body;
using model::Camera;
using model::Collider;
using model::Cut;
using model::Emitter;
using model::Floor;
using model::ForceField;
using model::Light;
using model::Look;
using model::LookType;
using model::Mark;
using model::Material;
using model::MeshSequence;
using model::Motion;
using model::Output;
using model::Probe;
using model::Render;
using model::Rigid;
using model::SceneProps;
using model::Sink;
using model::Space;
using model::Sun;
using model::Surface;
using model::SurfaceFormat;
using model::Time;
using model::Video;

const std::vector<std::string>& wall_type_words();  ///< by WallType

const Schema<Space>& space_schema();
const Schema<Time>& time_schema();
const Schema<Output>& output_schema();
const Schema<Surface>& surface_schema();
const Schema<Render>& render_schema();
Field<Render> camera();
/// Sky, sun and what stands around. A place brings a sky of its own, which the keys of the light
/// change.
Field<Render> light_field();
Field<Render> stage_field();
void finish_light(const YamlNode* render, Render& out);
const Schema<Video>& video_schema();
const Schema<Material>& material_schema();

/// Checks min < max; periodic axes have no walls.
void finish_space(Reading& in, const YamlNode& node, Space& space);

/// rigid: of a body whose `position` stands beside the shape.
enum class ShapeUse { body, collider, rigid };
/// Keys beside the form: how large a shape is and how it is turned.
Field<Shape> fit_field();
Field<Shape> scale_field();
Field<Shape> rotate_field();
/// Reads a shape; reports what is wrong.
void read_shape(Reading& in, const YamlNode& node, const std::string& path, ShapeUse use, Shape& out);
YamlNode write_shape(const Shape& shape);
ValueInfo shape_info();

/// Says where the `max` of a map is not above its `min`, both of which it has.
void check_min_max(Reading& in, const YamlNode& map, const std::string& path, const Box3d& box);

/// The name of one of `materials`.
template <class T>
Field<T> material_name(const std::vector<Material>& materials, std::string T::* member) {
  return Field<T>{"material",
                  [&materials, member](Reading& in, const YamlNode& n, const std::string& path, T& out) {
                    std::vector<std::string> names;
                    for (const Material& m : materials) names.push_back(m.name);
                    const auto name = read_text(in.problems, n, path);
                    if (!name) return;
                    const auto found = std::find(names.begin(), names.end(), *name);
                    if (found == names.end())
                      in.problems.error(n.at,
                                        fmt::format("{}: no material '{}'{}", path, *name, suggest(*name, names)));
                    else
                      out.*member = *name;
                  },
                  [member](const T& t, const std::string& k, YamlNode& map) { map.put(k, write_text(t.*member)); }}
      .must()
      .takes(text_info("the name of a material"));
}

/// A file as it is named, or the one that was found: it is looked for beside the scene, then from
/// the working folder; that of a run in its folder alone. Reports one that is nowhere.
std::string find_file(Reading& in, const YamlNode& n, const std::string& path, const std::string& name);

/// True if a shape is a sequence of meshes, which read_sequence reads.
bool is_sequence(const YamlNode& shape);
void read_sequence(Reading& in, const YamlNode& node, const std::string& path, MeshSequence& out);
YamlNode write_sequence(const MeshSequence& sequence);
ValueInfo sequence_info();

/// rotate: {axis, angle}
struct Turn {
  Vec3d axis{0, 1, 0};
  double angle = 0;  ///< degrees
};
/// Angles of up to `most` degrees either way.
Schema<Turn> turn_schema(double most);

const Schema<Motion>& motion_schema();
/// motion: of what has one, a collider, a pin, an emitter or a sink.
template <class T>
Field<T> motion_field() {
  return Field<T>{"motion",
                  [](Reading& in, const YamlNode& n, const std::string& path, T& out) {
                    read_map(in, n, path, motion_schema(), out.motion.emplace());
                  },
                  [](const T& one, const std::string& k, YamlNode& map) {
                    if (one.motion) map.put(k, write_map(*one.motion, motion_schema()));
                  }}
      .takes(map_of(motion_schema(), "motion"))
      .says("How it moves; it stands still if absent.");
}

/// The keys of a material that say its transfer: `transfer`, and the parameters of every type.
const std::vector<std::string>& transfer_keys();
void read_transfer(Reading& in, const YamlNode& material, const std::string& path, Material& out);
void write_transfer(const Material& from, YamlNode& material);
std::vector<KeyInfo> transfer_info();

/// foam: what is finer than particles.
Field<model::Scene> foam();
const Schema<model::Foam>& foam_schema();
/// Checks the names in foam.of, and that there is matter that foams.
void check_foam(Reading& in, const YamlNode* foam, const model::Scene& scene);

/// gravity: [x, y, z], or {keys: [{t, value}, ...]}
Field<model::Scene> gravity();

/// These read into the lists of the scene; bodies need the materials to be read first.
void read_materials(Reading& in, const YamlNode& node, model::Scene& out);
void read_bodies(Reading& in, const YamlNode& node, model::Scene& out);
/// Checks the names in the `cut` of bodies, once there are colliders and rigid bodies.
void check_cuts(Reading& in, const YamlNode* bodies, const model::Scene& scene);
void read_colliders(Reading& in, const YamlNode& node, model::Scene& out);
void read_emitters(Reading& in, const YamlNode& node, model::Scene& out);
void read_sinks(Reading& in, const YamlNode& node, model::Scene& out);
/// Rigid bodies: colliders of the scene.
void read_rigid(Reading& in, const YamlNode& node, model::Scene& out);
YamlNode write_rigid(const model::Scene& scene);
/// Reads pins, which hold matter and move it: colliders of the scene that are not drawn.
void read_pins(Reading& in, const YamlNode& node, model::Scene& out);
YamlNode write_pins(const model::Scene& scene);
void read_fields(Reading& in, const YamlNode& node, model::Scene& out);
/// Needs everything that a probe can name: space, materials, bodies, colliders.
void read_probes(Reading& in, const YamlNode& node, model::Scene& out);
YamlNode write_materials(const model::Scene& scene);
YamlNode write_bodies(const model::Scene& scene);
YamlNode write_colliders(const model::Scene& scene);
YamlNode write_emitters(const model::Scene& scene);
YamlNode write_sinks(const model::Scene& scene);
YamlNode write_fields(const model::Scene& scene);
YamlNode write_probes(const model::Scene& scene);

/// Descriptions of the keys of these sections.
ValueInfo materials_info();
ValueInfo bodies_info();
ValueInfo colliders_info();
ValueInfo emitters_info();
ValueInfo sinks_info();
ValueInfo rigid_info();
ValueInfo pins_info();
ValueInfo fields_info();
ValueInfo probes_info();

/// Reads a look over the one that holds without it.
void read_look(Reading& in, const YamlNode& node, const std::string& path, Look& out);
/// Gives every material and collider its look: the one in the scene's render.looks, else
/// `default_look` for materials and matte gray for colliders. Checks the names in render.cut.
void read_looks(Reading& in, const YamlNode& root, model::Scene& scene);

/// The value of a key of what may be null, or no map; null if it is not there.
inline const YamlNode* find_in(const YamlNode* map, std::string_view key) {
  return map && map->is_map() ? map->find(key) : nullptr;
}

/// Checks that what is blurred has velocities.
void check_shutter(Reading& in, const YamlNode* render, const model::Scene& scene);

/// The whole scene, without dreampm and variants.
const Schema<model::Scene>& scene_schema();
/// Reads a whole scene and completes it: what follows from the rest, as looks and the folder.
model::Scene read_scene(Reading& in, const YamlNode& root, const std::string& variant);

const Schema<Wall>& wall_schema();
const Schema<Collider>& collider_schema();
/// Names are looked up in `materials`.
Schema<Emitter> emitter_schema(const std::vector<Material>& materials);
const Schema<Look>& look_schema();

/// Names end up in paths, file names and --set.
bool good_name(std::string_view name);
inline constexpr const char* good_name_rule = "letters, digits, - and _, beginning with a letter or digit, at most 64";

/// Adds one to a list, with its name.
template <class T>
T& add_named(std::vector<T>& list, const Entry& e) {
  T& one = list.emplace_back();
  one.name = e.key;
  return one;
}

/// Calls `each` for every entry of a map of names, and notes their places; reports names that
/// cannot be used in paths and file names.
void read_named(Reading& in, const YamlNode& node, const std::string& path,
                const std::function<void(const Entry&, const std::string& path)>& each);

}  // namespace dreampm::scene
