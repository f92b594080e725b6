// Placement and size of shapes: fit, scale, rotate. And readers that sections share: turns, files,
// boxes.
#include <filesystem>

#include "dreampm/scene/sections.h"

namespace dreampm::scene {
namespace {

struct Fit {
  double longest = 1;
};
const Schema<Fit>& fit_schema() {
  static const Schema<Fit> schema{number("longest", &Fit::longest, above_zero("m")).must().says("Its longest side.")};
  return schema;
}

/// A mesh that is no height field.
bool is_model(const Shape& s) {
  const MeshShape* m = std::get_if<MeshShape>(&s.form);
  return m && !m->heights;
}

template <class S>
bool is(const Shape& s) {
  return std::holds_alternative<S>(s.form);
}

const Schema<Turn>& shape_turn_schema() {
  static const Schema<Turn> schema = turn_schema(360);
  return schema;
}

Field<Turn> axis() {
  return Field<Turn>{
      "axis",
      [](Reading& in, const YamlNode& n, const std::string& path, Turn& out) {
        if (n.kind == YamlNode::Kind::list) {
          const auto v = read_vector(in.problems, n, path, {});
          if (v && length(*v) == 0) in.problems.error(n.at, fmt::format("{} is zero: it must have a direction", path));
          if (v) out.axis = *v;
        } else if (const auto w = read_word(in.problems, n, path, std::vector<std::string>{"x", "y", "z"})) {
          out.axis = {double(*w == "x"), double(*w == "y"), double(*w == "z")};
        }
      },
      [](const Turn& t, const std::string& k, YamlNode& map) { map.put(k, write_vector(t.axis)); }}
      .takes(either({word_info({"x", "y", "z"}), vector_info({})}))
      .says("The axis, by its name or as a vector.");
}

}  // namespace

Schema<Turn> turn_schema(double most) {
  return {axis(), number("angle", &Turn::angle, between(-most, most, "degrees"))
                      .must()
                      .says("How far, by the right hand about the axis.")};
}

std::string find_file(Reading& in, const YamlNode& n, const std::string& path, const std::string& name) {
  namespace fs = std::filesystem;
  std::error_code none;
  const fs::path beside = (fs::path(in.folder) / name).lexically_normal();
  if (in.models == Reading::Models::in_folder) return beside.string();
  if (in.models == Reading::Models::as_named) return name;
  for (const fs::path& p : {beside, fs::path(name)})
    if (fs::is_regular_file(p, none)) return p.string();
  in.problems.error(
      n.at, fmt::format("{} is '{}': no such file, neither beside the scene nor in the working folder", path, name));
  return name;
}

void check_min_max(Reading& in, const YamlNode& map, const std::string& path, const Box3d& box) {
  for (int i = 0; i < 3; ++i)
    if (!(box.max[i] > box.min[i]))
      in.problems.error(map.find("max")->items[std::size_t(i)].at,
                        fmt::format("{0}.max[{1}] is {2}: must be above {0}.min[{1}], which is {3}", path, i,
                                    box.max[i], box.min[i]));
}

Field<Shape> fit_field() {
  return Field<Shape>{"fit",
                      [](Reading& in, const YamlNode& n, const std::string& path, Shape& out) {
                        Fit f;
                        read_map(in, n, path, fit_schema(), f);
                        std::get<MeshShape>(out.form).longest = f.longest;
                      },
                      [](const Shape& s, const std::string& k, YamlNode& map) {
                        if (const auto l = std::get<MeshShape>(s.form).longest)
                          map.put(k, write_map(Fit{*l}, fit_schema()));
                      }}
      .when(is_model, "meshes")
      .no_default()
      .takes(map_of(fit_schema(), "shape.fit"))
      .says("Scales a mesh to a size, in place of `scale`.");
}

Field<Shape> scale_field() {
  return Field<Shape>{"scale",
                      [](Reading& in, const YamlNode& n, const std::string& path, Shape& out) {
                        const auto v = read_number(in.problems, n, path, above_zero());
                        if (!v) return;
                        if (MeshShape* m = std::get_if<MeshShape>(&out.form))
                          m->scale = *v;
                        else
                          std::get<PointsShape>(out.form).scale = *v;
                      },
                      [](const Shape& s, const std::string& k, YamlNode& map) {
                        const MeshShape* m = std::get_if<MeshShape>(&s.form);
                        if (!m)
                          map.put(k, write_number(std::get<PointsShape>(s.form).scale));
                        else if (m->scale)
                          map.put(k, write_number(*m->scale));
                      }}
      .when([](const Shape& s) { return is_model(s) || is<PointsShape>(s); }, "meshes and points")
      .no_default()
      .takes(number_info(above_zero("m")))
      .says("The length of the file's unit; absent: 1.");
}

Field<Shape> rotate_field() {
  return Field<Shape>{"rotate",
                      [](Reading& in, const YamlNode& n, const std::string& path, Shape& out) {
                        Turn t;
                        read_map(in, n, path, shape_turn_schema(), t);
                        if (t.angle != 0) out.rotate_axis = t.axis, out.rotate_angle = t.angle;
                      },
                      [](const Shape& s, const std::string& k, YamlNode& map) {
                        if (s.rotate_angle != 0)
                          map.put(k, write_map(Turn{s.rotate_axis, s.rotate_angle}, shape_turn_schema()));
                      }}
      .when([](const Shape& s) { return !is<SphereShape>(s) && !is<PlaneShape>(s); },
            "boxes, cylinders, meshes, height fields, points, combinations and containers")
      .no_default()
      .takes(map_of(shape_turn_schema(), "rotate"))
      .says("Turns it about its center.");
}

}  // namespace dreampm::scene
