// Shapes: one table of forms, each with the keys that may stand beside it.
#include <fmt/ranges.h>

#include "dreampm/scene/sections.h"

namespace dreampm::scene {
namespace {

/// The entries of a map that say a form.
std::vector<const Entry*> forms_in(const YamlNode& map) {
  std::vector<const Entry*> forms;
  for (const Entry& e : map.entries)
    if (std::find(shape_forms().begin(), shape_forms().end(), e.key) != shape_forms().end()) forms.push_back(&e);
  return forms;
}

/// Forms that have an inside and end somewhere.
std::vector<std::string> forms_of_solids() {
  std::vector<std::string> forms = shape_forms();
  std::erase_if(forms, [](const std::string& f) { return f == "plane" || f == "points" || f == "heightfield"; });
  return forms;
}

/// A shape of which it does not matter whether it says its center. `others`: keys that the caller
/// reads. Whether it has one form.
bool read_form(Reading& in, const YamlNode& node, const std::string& path, ShapeUse use, Shape& out,
               const std::vector<std::string>& others);

struct BoxDraft {
  std::optional<Vec3d> min, max, size;
};

const Schema<BoxDraft>& box_schema() {
  static const Schema<BoxDraft> schema{
      vector("min", &BoxDraft::min, any_number("m")).says("Its low corner."),
      vector("max", &BoxDraft::max, any_number("m")).says("Its high corner."),
      vector("size", &BoxDraft::size, above_zero("m")).says("Its sides, with a `center` beside the box.")};
  return schema;
}

const Schema<SphereShape>& sphere_schema() {
  static const Schema<SphereShape> schema{
      number("radius", &SphereShape::radius, above_zero("m")).must().says("Its radius.")};
  return schema;
}

const Schema<CylinderShape>& cylinder_schema() {
  static const Schema<CylinderShape> schema{
      number("radius", &CylinderShape::radius, above_zero("m")).must().says("Its radius."),
      number("height", &CylinderShape::height, above_zero("m")).must().says("Its length; it stands along y.")};
  return schema;
}

const Schema<PlaneShape>& plane_schema() {
  static const Schema<PlaneShape> schema{
      vector("point", &PlaneShape::point, any_number("m")).must().says("A point of its surface."),
      vector("normal", &PlaneShape::normal).must().says("Out of the solid; any length above 0.")};
  return schema;
}

/// Returns a predicate for meshes or for height fields; each writes its own.
template <bool heights>
std::function<bool(const Shape&)> is_mesh() {
  return [](const Shape& s) {
    const MeshShape* m = std::get_if<MeshShape>(&s.form);
    return m && m->heights.has_value() == heights;
  };
}

template <class T>
Field<T> direction(std::string key, Vec3d T::* member) {
  Field<T> f = vector(std::move(key), member);
  f.read = [=, read = f.read](Reading& in, const YamlNode& n, const std::string& path, T& out) {
    const int before = in.problems.errors();
    read(in, n, path, out);
    if (in.problems.errors() == before && length(out.*member) == 0)
      in.problems.error(n.at, fmt::format("{} is zero: it must have a direction", path));
  };
  return f;
}

template <class S>
std::function<bool(const Shape&)> has() {
  return [](const Shape& s) { return std::holds_alternative<S>(s.form); };
}

MapInfo box_info() {
  MapInfo info{keys_info(box_schema())};
  info.one_of = {{"min", "max"}, {"size"}};
  return info;
}

void read_box(Reading& in, const YamlNode& n, const std::string& path, Shape& out) {
  BoxDraft b;
  const int before = in.problems.errors();
  out.form = BoxShape{};
  read_map(in, n, path, box_schema(), b);
  if (in.problems.errors() > before) return;
  if (b.size) {
    out.form = BoxShape{*b.size};
    return;
  }
  if (!b.min || !b.max)
    return in.problems.error(n.at, fmt::format("{} needs min and max, or size with a center beside it", path));
  check_min_max(in, n, path, {*b.min, *b.max});
  out.form = BoxShape{*b.max - *b.min};
  out.center = (*b.min + *b.max) * 0.5;
}

void read_plane(Reading& in, const YamlNode& n, const std::string& path, Shape& out) {
  const int before = in.problems.errors();
  read_map(in, n, path, plane_schema(), out.form.emplace<PlaneShape>());
  if (in.problems.errors() == before && length(std::get<PlaneShape>(out.form).normal) == 0)
    in.problems.error(n.find("normal")->at, fmt::format("{}.normal is zero: it must point out of the solid", path));
}

void read_mesh(Reading& in, const YamlNode& n, const std::string& path, Shape& out) {
  MeshShape& mesh = out.form.emplace<MeshShape>();
  const auto name = read_text(in.problems, n, path);
  if (!name) return;
  mesh.path = *name;
  if (!name->starts_with("asset:")) {
    mesh.path = find_file(in, n, path, *name);
  } else if (const std::string asset = name->substr(6);
             std::find(in.assets.begin(), in.assets.end(), asset) == in.assets.end()) {
    in.problems.error(n.at, fmt::format("{} is '{}': no such asset{}", path, *name, suggest(asset, in.assets)));
  }
}

void read_points(Reading& in, const YamlNode& n, const std::string& path, Shape& out) {
  PointsShape& points = out.form.emplace<PointsShape>();
  if (const auto name = read_text(in.problems, n, path)) points.path = find_file(in, n, path, *name);
}

template <class S>
Field<Shape> form(std::string key, const Schema<S>& schema) {
  return Field<Shape>{key,
                      [&schema](Reading& in, const YamlNode& n, const std::string& path, Shape& out) {
                        read_map(in, n, path, schema, out.form.template emplace<S>());
                      },
                      [&schema](const Shape& s, const std::string& k, YamlNode& map) {
                        if (const S* f = std::get_if<S>(&s.form)) map.put(k, write_map(*f, schema));
                      }}
      .takes(map_of(schema, "shape." + key));
}

template <class S>
Field<Shape> file_form(std::string key,
                       std::function<void(Reading&, const YamlNode&, const std::string&, Shape&)> read) {
  return Field<Shape>{std::move(key), std::move(read),
                      [](const Shape& s, const std::string& k, YamlNode& map) {
                        if (const S* f = std::get_if<S>(&s.form)) map.put(k, write_text(f->path));
                      }}
      .no_default()
      .takes(text_info("a file"));
}

Field<Shape> boolean(std::string key, BooleanShape::Op op, ShapeUse use) {
  return Field<Shape>{
      std::move(key),
      [=](Reading& in, const YamlNode& n, const std::string& path, Shape& out) {
        BooleanShape& b = out.form.emplace<BooleanShape>();
        b.op = op;
        if (!expect_list(in.problems, n, path)) return;
        if (n.items.size() < 2)
          in.problems.error(n.at, fmt::format("{} has {} shapes: must have 2 or more", path, n.items.size()));
        for (std::size_t i = 0; i < n.items.size(); ++i) {
          Shape part;
          const std::string name = fmt::format("{}[{}]", path, i);
          read_shape(in, n.items[i], name, use, part);
          if (std::holds_alternative<PointsShape>(part.form))
            in.problems.error(n.items[i].at, fmt::format("{} is a point cloud: it has no inside to combine", name));
          b.parts.push_back(std::move(part));
        }
      },
      [=](const Shape& s, const std::string& k, YamlNode& map) {
        const BooleanShape* b = std::get_if<BooleanShape>(&s.form);
        if (!b || b->op != op) return;
        std::vector<YamlNode> parts;
        for (const Shape& p : b->parts) parts.push_back(write_shape(p));
        map.put(k, YamlNode::list(std::move(parts)));
      }}
      .takes(list_info(shape_info(), 2));
}

const Schema<ContainerShape>& container_schema() {
  static const Schema<ContainerShape> schema{
      number("wall", &ContainerShape::wall, above_zero("m"))
          .must()
          .says("How far the block reaches beyond the hollow, or how thick the shell is."),
      choice("open", &ContainerShape::open, {"top"}).says("The side that is open."),
      direction("up", &ContainerShape::up).says("The direction of the hollow that points up once it is turned."),
      number("cut", &ContainerShape::cut, at_least_zero("m"))
          .says("How far below the top of the hollow the container ends; absent: 0.05 of its height."),
      choice("form", &ContainerShape::form, {"block", "shell"})
          .says("A box without the hollow, or a wall that follows the hollow."),
  };
  return schema;
}

/// The keys of the container and of its hollow stand side by side.
Field<Shape> container() {
  return Field<Shape>{
      "container",
      [](Reading& in, const YamlNode& n, const std::string& path, Shape& out) {
        ContainerShape& c = out.form.emplace<ContainerShape>();
        if (!expect_map(in.problems, n, path)) return;
        const std::vector<const Entry*> forms = forms_in(n);
        if (forms.empty())
          in.problems.error(n.at,
                            fmt::format("{} has no hollow: give one of {}", path, fmt::join(forms_of_solids(), ", ")));
        else if (forms[0]->key == "plane")
          in.problems.error(forms[0]->at, fmt::format("{}.plane: a hollow must end somewhere", path));
        else
          read_form(in, n, path, ShapeUse::collider, c.hollow.emplace_back(), container_keys());
        YamlNode own = n;
        std::erase_if(own.entries, [](const Entry& e) {
          return std::find(container_keys().begin(), container_keys().end(), e.key) == container_keys().end();
        });
        read_map(in, own, path, container_schema(), c);
      },
      [](const Shape& s, const std::string& k, YamlNode& map) {
        const ContainerShape* c = std::get_if<ContainerShape>(&s.form);
        if (!c) return;
        YamlNode both = c->hollow.empty() ? YamlNode::map() : write_shape(c->hollow[0]);
        for (Entry& e : write_map(*c, container_schema()).entries) both.entries.push_back(std::move(e));
        map.put(k, std::move(both));
      }}
      .takes(map_of(
          [] {
            MapInfo info{keys_info(container_schema())};
            const ValueInfo hollow = shape_info();
            MapInfo keys = std::get<MapOf>(hollow.form).make();
            for (KeyInfo& key : keys.keys)
              if (key.key != "plane" && key.key != "points") info.keys.push_back(std::move(key));
            for (const std::string& form : forms_of_solids()) info.one_of.push_back({form});
            info.one_of.push_back({"heightfield"});
            return info;
          },
          "shape.container"))
      .says("A block or shell about a hollow, open at the top; the keys of the hollow stand beside its own.");
}

struct HeightsDraft {
  std::string image;
  Vec3d min, max;
};

/// A picture of heights in a box.
Field<Shape> heightfield() {
  static const Schema<HeightsDraft> schema{
      Field<HeightsDraft>{
          "image",
          [](Reading& in, const YamlNode& n, const std::string& path, HeightsDraft& out) {
            if (const auto name = read_text(in.problems, n, path)) out.image = find_file(in, n, path, *name);
          },
          [](const HeightsDraft& d, const std::string& k, YamlNode& map) { map.put(k, write_text(d.image)); }}
          .must()
          .takes(text_info("a file"))
          .says("A PNG: black is the bottom of the box, white its top."),
      vector("min", &HeightsDraft::min, any_number("m")).must().says("The low corner of its box."),
      vector("max", &HeightsDraft::max, any_number("m")).must().says("The high corner of its box."),
  };
  return Field<Shape>{"heightfield",
                      [](Reading& in, const YamlNode& n, const std::string& path, Shape& out) {
                        HeightsDraft d;
                        const int before = in.problems.errors();
                        read_map(in, n, path, schema, d);
                        MeshShape& mesh = out.form.emplace<MeshShape>();
                        mesh.path = d.image, mesh.heights = Box3d{d.min, d.max};
                        if (in.problems.errors() > before) return;
                        check_min_max(in, n, path, *mesh.heights);
                      },
                      [](const Shape& s, const std::string& k, YamlNode& map) {
                        if (const MeshShape* m = std::get_if<MeshShape>(&s.form); m && m->heights)
                          map.put(k, write_map(HeightsDraft{m->path, m->heights->min, m->heights->max}, schema));
                      }}
      .takes(map_of(schema, "shape.heightfield"))
      .says("Ground: a picture of heights in a box.");
}

Schema<Shape> make_schema(ShapeUse use) {
  using Op = BooleanShape::Op;
  Schema<Shape> s{
      Field<Shape>{"box", read_box,
                   [](const Shape& shape, const std::string& k, YamlNode& map) {
                     if (const BoxShape* b = std::get_if<BoxShape>(&shape.form)) {
                       YamlNode box = YamlNode::map();
                       box.put("size", write_vector(b->size));
                       map.put(k, std::move(box));
                     }
                   }}
          .takes(map_of(box_info, "shape.box"))
          .says("A box: its corners, or its size with a `center` beside it."),
      form<SphereShape>("sphere", sphere_schema()).says("A ball."),
      form<CylinderShape>("cylinder", cylinder_schema()).says("An upright cylinder."),
      written_when<Shape>(file_form<MeshShape>("mesh", read_mesh), is_mesh<false>())
          .says("A mesh: PLY, STL, OBJ, OFF, glTF, or asset:NAME."),
      boolean("union", Op::unite, use).says("Shapes put together."),
      boolean("difference", Op::difference, use).says("The first shape without the others."),
      boolean("intersection", Op::intersection, use).says("What all of the shapes share."),
      container(),
      heightfield(),
  };
  Field<Shape> plane = form<PlaneShape>("plane", plane_schema()).says("All that is behind a plane.");
  plane.read = read_plane;
  Field<Shape> points =
      file_form<PointsShape>("points", read_points).says("A cloud of points, one particle a point: PLY.");
  if (use == ShapeUse::body) {
    s.push_back(std::move(points));
    s.push_back(std::move(plane).refused("colliders: a body must end somewhere"));
  } else {
    s.push_back(std::move(plane));
    s.push_back(std::move(points).refused("bodies: a point cloud has no inside"));
  }
  s.push_back(fit_field());
  s.push_back(scale_field());
  s.push_back(rotate_field());
  s.push_back(vector("center", &Shape::center, any_number("m"))
                  .when([](const Shape& shape) { return !has<PlaneShape>()(shape); }, "shapes other than planes")
                  .says("Where its center is; needed where the form has no place by itself."));
  return s;
}

const Schema<Shape>& shape_schema(ShapeUse use) {
  static const Schema<Shape> body = make_schema(ShapeUse::body), collider = make_schema(ShapeUse::collider);
  return use == ShapeUse::body ? body : collider;
}

bool read_form(Reading& in, const YamlNode& node, const std::string& path, ShapeUse use, Shape& out,
               const std::vector<std::string>& others) {
  if (!expect_map(in.problems, node, path)) return false;
  const std::vector<const Entry*> forms = forms_in(node);
  if (forms.size() > 1) {
    in.problems.error(forms[1]->at, fmt::format("{} is a {} and a {}: give one form, or a union", path, forms[0]->key,
                                                forms[1]->key));
    return false;
  }
  read_map(in, node, path, shape_schema(use), out, others);
  if (forms.empty()) {
    in.problems.error(node.at, fmt::format("{} has no form: give one of {}", path, fmt::join(shape_forms(), ", ")));
    return false;
  }
  const YamlNode* box = node.find("box");
  const auto center =
      std::find_if(node.entries.begin(), node.entries.end(), [](const Entry& e) { return e.key == "center"; });
  if (box && (box->find("min") || box->find("max")) && center != node.entries.end())
    in.problems.error(center->at,
                      fmt::format("{0}.center together with {0}.box.min and max: give size with center", path));
  return true;
}

/// True if the map gives a place for its form; combinations and meshes have one by themselves.
bool lies_somewhere(const YamlNode& node) {
  if (node.find("center")) return true;
  if (const YamlNode* box = node.find("box")) return box->find("min") || box->find("max");
  if (const YamlNode* hollow = node.find("container"))
    return !hollow->is_map() || forms_in(*hollow).size() != 1 || lies_somewhere(*hollow);
  return !node.find("sphere") && !node.find("cylinder");
}

}  // namespace

void read_shape(Reading& in, const YamlNode& node, const std::string& path, ShapeUse use, Shape& out) {
  if (read_form(in, node, path, use, out, {}) && use != ShapeUse::rigid && !lies_somewhere(node))
    in.problems.error(node.at, fmt::format("missing key '{}.center'", path));
}

/// The keys of all uses: what one of them does not have it refuses.
MapInfo all_shapes() {
  MapInfo info{keys_info(shape_schema(ShapeUse::collider))};
  for (KeyInfo& key : keys_info(shape_schema(ShapeUse::body))) {
    if (info.find(key.key)) continue;
    key.only = "bodies";
    const auto plane = std::find_if(info.keys.begin(), info.keys.end(), [](const auto& k) { return k.key == "plane"; });
    plane->only = "colliders and probes";
    info.keys.insert(plane + 1, std::move(key));
  }
  for (const std::string& form : shape_forms()) info.one_of.push_back({form});
  return info;
}

ValueInfo shape_info() { return map_of(all_shapes, "shape"); }

YamlNode write_shape(const Shape& shape) {
  return write_map(shape,
                   shape_schema(std::holds_alternative<PlaneShape>(shape.form) ? ShapeUse::collider : ShapeUse::body));
}

}  // namespace dreampm::scene
