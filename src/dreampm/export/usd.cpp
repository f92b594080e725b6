// USD: one animated text file (.usda) with a Points for each material, a Mesh for each meshed one
// and for each collider and rigid body, their materials and a camera. The schemas are those of
// UsdGeom and UsdShade (https://openusd.org/release/api/usd_geom_page_front.html).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "dreampm/export/formats.h"
#include "dreampm/export/usd_samples.h"

namespace dreampm::exchange {
namespace fs = std::filesystem;
namespace {

constexpr const char* per_point = R"(interpolation = "vertex")";

std::string text_of(const Vec3f& v) { return fmt::format("({}, {}, {})", v.x, v.y, v.z); }
std::string text_of(const Vec3d& v) { return fmt::format("({}, {}, {})", v.x, v.y, v.z); }

/// Lower and upper corner, as the attribute `extent` has them.
std::vector<Vec3f> extent(std::span<const Vec3f> points, float margin) {
  if (points.empty()) return {Vec3f{}, Vec3f{}};
  Box3f box;
  for (const Vec3f& p : points) box.add(p);
  const Vec3f m{margin, margin, margin};
  return {box.min - m, box.max + m};
}

/// Gives out names within one parent, each once.
class Names {
 public:
  std::string take(const std::string& wish) {
    std::string name = usd_name(wish);
    while (!taken_.insert(name).second) name += "_";
    return name;
  }

 private:
  std::set<std::string> taken_;
};

/// The numbers of temporary files.
class Numbers {
 public:
  explicit Numbers(fs::path target) : target_(std::move(target)) {}
  UsdSamples samples(std::string head, std::string metadata = {}) {
    return UsdSamples(target_, next_++, std::move(head), std::move(metadata));
  }
  std::unique_ptr<UsdSamples> more(std::string head, std::string metadata) {
    return std::make_unique<UsdSamples>(target_, next_++, std::move(head), std::move(metadata));
  }

 private:
  fs::path target_;
  std::size_t next_ = 1;
};

/// The particles of one material.
class PointsPrim {
 public:
  /// `own_widths`: each has a radius, the column of that name; else all are `width` wide.
  PointsPrim(Numbers& numbers, std::string name, std::uint8_t material, float width, bool own_widths = false)
      : name_(std::move(name)),
        material_(material),
        width_(width),
        own_widths_(own_widths),
        numbers_(numbers),
        extent_(numbers.samples("float3[] extent")),
        points_(numbers.samples("point3f[] points")),
        velocities_(numbers.samples("vector3f[] velocities")),
        ids_(numbers.samples("int64[] ids")),
        widths_(numbers.samples("float[] widths", per_point)) {}

  void add(int number, const ParticleFrame& frame, const std::vector<Vec3f>& colors) {
    std::vector<std::size_t> own;
    for (std::size_t i = 0; i < frame.size(); ++i)
      if (frame.material[i] == material_) own.push_back(i);
    const auto chosen = [&](const auto& column) {
      std::vector<typename std::decay_t<decltype(column)>::value_type> out;
      out.reserve(own.size());
      for (const std::size_t i : own) out.push_back(column[i]);
      return out;
    };
    const std::vector<Vec3f> points = chosen(frame.position);
    float widest = own_widths_ ? 0 : width_;
    points_.add(number, points);
    velocities_.add(number, chosen(frame.velocity));
    ids_.add<std::int32_t>(number, chosen(frame.id));
    for (const auto& [name, values] : frame.columns)
      if (name == "radius" && own_widths_) {
        std::vector<float> widths = chosen(values);
        for (float& w : widths) w *= 2;
        for (const float w : widths) widest = std::max(widest, w);
        widths_.add<float>(number, widths);
      } else if (values.size() == frame.size())
        column(name).add<float>(number, chosen(values));
    extent_.add(number, extent(points, widest / 2));
    if (colors.empty()) return;
    if (!colors_) colors_ = numbers_.more("color3f[] primvars:displayColor", per_point);
    colors_->add(number, chosen(colors));
  }

  void write(ByteSink& out, const ClipMaterial& material) {
    out.text(fmt::format("    def Points \"{}\"\n    {{\n", name_));
    for (UsdSamples* s : {&extent_, &points_, &velocities_, &ids_}) s->copy_to(out, "        ");
    if (own_widths_)
      widths_.copy_to(out, "        ");
    else
      out.text(fmt::format("        float[] widths = [{}] (interpolation = \"constant\")\n", width_));
    for (auto& [name, samples] : columns_) samples->copy_to(out, "        ");
    if (colors_)
      colors_->copy_to(out, "        ");
    else
      out.text(fmt::format("        color3f[] primvars:displayColor = [{}] (interpolation = \"constant\")\n",
                           text_of(material.color)));
    out.text("    }\n");
  }

 private:
  UsdSamples& column(const std::string& name) {
    auto& samples = columns_[name];
    if (!samples) samples = numbers_.more(fmt::format("float[] primvars:{}", usd_name(name)), per_point);
    return *samples;
  }
  std::string name_;
  std::uint8_t material_;
  float width_;
  bool own_widths_;
  Numbers& numbers_;
  UsdSamples extent_, points_, velocities_, ids_, widths_;
  std::map<std::string, std::unique_ptr<UsdSamples>> columns_;
  std::unique_ptr<UsdSamples> colors_;
};

/// The mesh of one material. Its faces are others in every frame.
class MeshPrim {
 public:
  MeshPrim(Numbers& numbers, std::string name, std::string look)
      : name_(std::move(name)),
        look_(std::move(look)),
        extent_(numbers.samples("float3[] extent")),
        points_(numbers.samples("point3f[] points")),
        normals_(numbers.samples("normal3f[] normals", per_point)),
        velocities_(numbers.samples("vector3f[] velocities")),
        counts_(numbers.samples("int[] faceVertexCounts")),
        indices_(numbers.samples("int[] faceVertexIndices")),
        numbers_(numbers) {}

  void add(int number, const TriMesh& mesh, const VertexAttributes& attributes = {}) {
    extent_.add(number, extent(mesh.vertices, 0));
    points_.add(number, mesh.vertices);
    if (!mesh.normals.empty()) normals_.add(number, mesh.normals);
    if (!mesh.velocities.empty()) velocities_.add(number, mesh.velocities);
    counts_.add<int>(number, std::vector<int>(mesh.triangles.size(), 3));
    const std::uint32_t* const first = mesh.triangles.empty() ? nullptr : mesh.triangles[0].data();
    indices_.add(number, std::span<const std::uint32_t>(first, 3 * mesh.triangles.size()));
    for (const VertexAttribute& a : attributes) {
      auto& samples = attributes_[a.name];
      if (!samples) samples = numbers_.more(head_of(a), per_point);
      samples->add(number, std::span<const float>(a.values), a.width());
    }
  }

  void write(ByteSink& out) {
    out.text(fmt::format(
        "    def Mesh \"{}\" (\n        prepend apiSchemas = [\"MaterialBindingAPI\"]\n    )\n    {{\n", name_));
    out.text(
        "        uniform token subdivisionScheme = \"none\"\n        uniform token orientation = \"rightHanded\"\n");
    for (UsdSamples* s : {&extent_, &points_, &normals_, &velocities_, &counts_, &indices_})
      s->copy_to(out, "        ");
    for (const auto& [name, samples] : attributes_) samples->copy_to(out, "        ");
    out.text(fmt::format("        rel material:binding = <{}>\n    }}\n", look_));
  }

 private:
  /// Whole numbers are written as such. A color of a vertex is what programs show.
  static std::string head_of(const VertexAttribute& a) {
    if (a.kind == AttributeKind::color) return "color3f[] primvars:displayColor";
    const char* type = a.kind == AttributeKind::vector ? "vector3f" : a.kind == AttributeKind::whole ? "int" : "float";
    return fmt::format("{}[] primvars:{}", type, usd_name(a.name));
  }
  std::string name_, look_;
  UsdSamples extent_, points_, normals_, velocities_, counts_, indices_;
  Numbers& numbers_;
  std::map<std::string, std::unique_ptr<UsdSamples>> attributes_;
};

/// A collider or a rigid body: one mesh and its transform over time.
class ObjectPrim {
 public:
  ObjectPrim(std::string name, std::string look, TriMesh mesh)
      : name_(std::move(name)), look_(std::move(look)), mesh_(std::move(mesh)) {}

  void add(int number, const Pose& pose) { poses_.emplace_back(number, pose); }

  void write(ByteSink& out) const {
    out.text(fmt::format(
        "    def Mesh \"{}\" (\n        prepend apiSchemas = [\"MaterialBindingAPI\"]\n    )\n    {{\n", name_));
    out.text(
        "        uniform token subdivisionScheme = \"none\"\n        uniform token orientation = \"rightHanded\"\n");
    const std::vector<Vec3f> corners = extent(mesh_.vertices, 0);
    const auto list = [&](const char* head, const std::vector<Vec3f>& values, const char* metadata) {
      std::string text = fmt::format("        {} = [", head);
      for (std::size_t i = 0; i < values.size(); ++i) text += (i > 0 ? ", " : "") + text_of(values[i]);
      out.text(text + fmt::format("]{}\n", metadata));
    };
    list("float3[] extent", corners, "");
    list("point3f[] points", mesh_.vertices, "");
    if (!mesh_.normals.empty()) list("normal3f[] normals", mesh_.normals, " (interpolation = \"vertex\")");
    std::string counts, indices;
    for (const auto& t : mesh_.triangles) {
      counts += counts.empty() ? "3" : ", 3";
      indices += fmt::format("{}{}, {}, {}", indices.empty() ? "" : ", ", t[0], t[1], t[2]);
    }
    out.text(fmt::format("        int[] faceVertexCounts = [{}]\n        int[] faceVertexIndices = [{}]\n", counts,
                         indices));
    if (moves()) write_transform(out);
    out.text(fmt::format("        rel material:binding = <{}>\n    }}\n", look_));
  }

 private:
  bool moves() const {
    return std::any_of(poses_.begin(), poses_.end(), [](const auto& p) { return !(p.second == Pose{}); });
  }
  /// Rows are what the axes become, as USD multiplies from the right.
  void write_transform(ByteSink& out) const {
    out.text("        matrix4d xformOp:transform.timeSamples = {\n");
    for (const auto& [number, pose] : poses_) {
      const auto row = [](const Vec3d& v, int w) { return fmt::format("({}, {}, {}, {})", v.x, v.y, v.z, w); };
      out.text(fmt::format("            {}: ( {}, {}, {}, {} ),\n", number, row(pose.rotation({1, 0, 0}), 0),
                           row(pose.rotation({0, 1, 0}), 0), row(pose.rotation({0, 0, 1}), 0), row(pose.position, 1)));
    }
    out.text("        }\n        uniform token[] xformOpOrder = [\"xformOp:transform\"]\n");
  }

  std::string name_, look_;
  TriMesh mesh_;
  std::vector<std::pair<int, Pose>> poses_;
};

class UsdWriter final : public ClipWriter {
 public:
  UsdWriter(const ClipInfo& clip, const fs::path& file) : clip_(clip), file_(file), numbers_(file) {
    Names names;
    root_ = usd_name(clip.name);
    looks_ = names.take("Looks"), camera_ = names.take("camera");
    for (const ClipMaterial& m : clip.materials) look_names_.push_back(in_looks_.take(m.name));
    const auto width = static_cast<float>(clip.spacing);
    if (clip.particles)
      for (std::size_t m = 0; m < clip.materials.size(); ++m)
        points_.push_back(std::make_unique<PointsPrim>(numbers_, names.take(clip.materials[m].name),
                                                       static_cast<std::uint8_t>(m), width));
    if (clip.foam)
      foam_ = std::make_unique<PointsPrim>(numbers_, names.take(clip.foam_look.name), std::uint8_t{0}, width, true);
    for (std::size_t m = 0; m < clip.meshed.size(); ++m)
      meshes_.push_back(std::make_unique<MeshPrim>(numbers_, names.take(clip.mesh_name(m)), path_of(look_of(m))));
    for (const ClipObject& o : clip.objects) {
      look_names_.push_back(in_looks_.take(o.look.name));
      const std::string name = names.take(o.look.name), look = path_of(look_names_.back());
      if (o.deforms)
        deforming_.push_back(std::make_unique<MeshPrim>(numbers_, name, look)), objects_.emplace_back();
      else
        deforming_.emplace_back(), objects_.emplace_back(std::in_place, name, look, o.mesh);
    }
  }

  void add(const ClipFrame& frame) override {
    for (const auto& p : points_) p->add(frame.number, frame.particles, frame.colors);
    if (foam_) foam_->add(frame.number, frame.foam, {});
    for (std::size_t m = 0; m < meshes_.size(); ++m)
      meshes_[m]->add(frame.number, frame.meshes[m], frame.attributes_of(m));
    for (std::size_t o = 0; o < objects_.size(); ++o)
      if (objects_[o])
        objects_[o]->add(frame.number, frame.objects[o].pose);
      else
        deforming_[o]->add(frame.number, frame.objects[o].mesh);
  }

  void finish() override {
    ByteSink out(file_.temporary(), file_.target());
    write_head(out);
    for (std::size_t m = 0; m < points_.size(); ++m) points_[m]->write(out, clip_.materials[m]);
    if (foam_) foam_->write(out, clip_.foam_look);
    for (const auto& m : meshes_) m->write(out);
    for (std::size_t o = 0; o < objects_.size(); ++o)
      if (objects_[o])
        objects_[o]->write(out);
      else
        deforming_[o]->write(out);
    if (clip_.camera) write_camera(out, *clip_.camera);
    out.text(fmt::format("    def Scope \"{}\"\n    {{\n", looks_));
    for (std::size_t m = 0; m < clip_.materials.size(); ++m) write_look(out, clip_.materials[m], look_names_[m]);
    for (std::size_t o = 0; o < clip_.objects.size(); ++o)
      write_look(out, clip_.objects[o].look, look_names_[clip_.materials.size() + o]);
    out.text("    }\n}\n");
    out.close();
    file_.commit();
  }

 private:
  std::string path_of(const std::string& look) const { return fmt::format("/{}/{}/{}", root_, looks_, look); }
  const std::string& look_of(std::size_t mesh) const { return look_names_[std::size_t(clip_.meshed[mesh])]; }

  void write_head(ByteSink& out) const {
    out.text(fmt::format(R"(#usda 1.0
(
    defaultPrim = "{}"
    doc = "Written by dreampm. Velocities are in units a second."
    startTimeCode = {}
    endTimeCode = {}
    timeCodesPerSecond = {}
    framesPerSecond = {}
    metersPerUnit = {}
    upAxis = "{}"
)

def Xform "{}" (
    kind = "component"
)
{{
)",
                         root_, clip_.first, clip_.last, clip_.fps, clip_.fps, 1 / clip_.axes.scale,
                         clip_.axes.up == Up::z ? "Z" : "Y", root_));
    if (clip_.shift == Vec3d{}) return;
    out.text(fmt::format("    double3 xformOp:translate = {}\n", text_of(clip_.shift)));
    out.text("    uniform token[] xformOpOrder = [\"xformOp:translate\"]\n");
  }

  /// Below the root, whose translation its place is without. Lengths of the lens are in tenths of a
  /// unit.
  void write_camera(ByteSink& out, const ClipCamera& c) const {
    constexpr double vertical = 20.955;  // of a 35 mm film, as UsdGeomCamera has it by default for the width
    const double focal = vertical / (2 * std::tan(c.fov * std::numbers::pi / 360));
    const auto row = [](const Vec3d& v, int w) { return fmt::format("({}, {}, {}, {})", v.x, v.y, v.z, w); };
    out.text(fmt::format(R"(    def Camera "{}"
    {{
        float2 clippingRange = ({}, {})
        float focalLength = {}
        float horizontalAperture = {}
        float verticalAperture = {}
        token projection = "perspective"
        matrix4d xformOp:transform = ( {}, {}, {}, {} )
        uniform token[] xformOpOrder = ["xformOp:transform"]
    }}
)",
                         camera_, c.far * 1e-4, c.far, focal, vertical * c.aspect, vertical, row(c.right, 0),
                         row(c.up, 0), row(-c.forward, 0), row(c.eye - clip_.shift, 1)));
  }

  void write_look(ByteSink& out, const ClipMaterial& m, const std::string& name) const {
    out.text(fmt::format(R"(        def Material "{0}"
        {{
            token outputs:surface.connect = </{1}/{2}/{0}/shader.outputs:surface>
            def Shader "shader"
            {{
                uniform token info:id = "UsdPreviewSurface"
                color3f inputs:diffuseColor = {3}
                float inputs:roughness = {4}
                float inputs:metallic = {5}
                float inputs:ior = {6}
                float inputs:opacity = {7}
                token outputs:surface
            }}
        }}
)",
                         name, root_, looks_, text_of(m.color), m.roughness, m.metallic, m.ior.value_or(1.5f),
                         m.ior ? 0.3 : 1.0));
  }

  ClipInfo clip_;
  Replacement file_;
  Numbers numbers_;
  std::string root_, looks_, camera_;
  Names in_looks_;
  std::vector<std::string> look_names_;  ///< of the materials, then of the objects
  std::vector<std::unique_ptr<PointsPrim>> points_;
  std::unique_ptr<PointsPrim> foam_;  ///< spray, foam, bubbles and dust
  std::vector<std::unique_ptr<MeshPrim>> meshes_;
  std::vector<std::optional<ObjectPrim>> objects_;    ///< one for each of ClipInfo::objects, or
  std::vector<std::unique_ptr<MeshPrim>> deforming_;  ///< where it deforms one here
};

std::unique_ptr<ClipWriter> write_usd_clip(const ClipInfo& clip, const fs::path& file) {
  return std::make_unique<UsdWriter>(clip, file);
}

}  // namespace

Format usd_format() {
  const auto itself = [](const ClipInfo&, const fs::path& target) { return std::vector<fs::path>{target}; };
  return {"usd", "one animated .usda", ".usda", false, itself, write_usd_clip};
}

}  // namespace dreampm::exchange
