// glTF 2.0: a .glb a frame with a primitive for each mesh, collider and rigid body and for the
// points of each material, their materials and a camera
// (https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html). Y is up there by definition.
#include <fmt/format.h>

#include <cctype>
#include <nlohmann/json.hpp>
#include <numbers>
#include <span>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/export/formats.h"
#include "dreampm/io/byte_sink.h"
#include "dreampm/io/numbered.h"
#include "dreampm/version.h"

namespace dreampm::exchange {
namespace fs = std::filesystem;
namespace {
using Json = nlohmann::ordered_json;

enum Mode { points = 0, triangles = 4 };  // as glTF counts them
enum Component { unsigned_int = 5125, float_number = 5126 };

std::string upper(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

template <class T>
Json triple(const Vec3<T>& v) {
  return {v.x, v.y, v.z};
}

/// JSON and buffer of one file.
class Document {
 public:
  explicit Document(const ClipInfo& clip) {
    json_["asset"] = {{"version", "2.0"}, {"generator", fmt::format("dreampm {}", version)}};
    json_["scene"] = 0;
    for (const char* list : {"scenes", "nodes", "meshes", "materials", "accessors", "bufferViews"})
      json_[list] = Json::array();
    for (const ClipMaterial& m : clip.materials) add_material(m);
  }
  Json& operator[](const char* key) { return json_[key]; }

  /// Returns its number.
  std::size_t add_material(const ClipMaterial& m) {
    Json material{{"name", m.name},
                  {"pbrMetallicRoughness",
                   {{"baseColorFactor", {m.color.x, m.color.y, m.color.z, 1}},
                    {"metallicFactor", m.metallic},
                    {"roughnessFactor", m.roughness}}}};
    if (m.ior) {
      material["extensions"] = {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                                {"KHR_materials_ior", {{"ior", *m.ior}}}};
      json_["extensionsUsed"] = {"KHR_materials_transmission", "KHR_materials_ior"};
    }
    json_["materials"].push_back(std::move(material));
    return json_["materials"].size() - 1;
  }
  /// An accessor of these values; returns its number.
  template <class T>
  std::size_t accessor(std::span<const T> values, Component component, const char* type, bool vertices) {
    while (buffer_.size() % 4 != 0) buffer_ += '\0';
    json_["bufferViews"].push_back({{"buffer", 0},
                                    {"byteOffset", buffer_.size()},
                                    {"byteLength", values.size_bytes()},
                                    {"target", vertices ? 34962 : 34963}});
    buffer_.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
    json_["accessors"].push_back({{"bufferView", json_["bufferViews"].size() - 1},
                                  {"componentType", int(component)},
                                  {"count", values.size()},
                                  {"type", type}});
    return json_["accessors"].size() - 1;
  }
  std::size_t positions(std::span<const Vec3f> values) {
    const std::size_t number = accessor(values, float_number, "VEC3", true);
    Box3f box;
    for (const Vec3f& v : values) box.add(v);
    json_["accessors"][number]["min"] = triple(box.min);
    json_["accessors"][number]["max"] = triple(box.max);
    return number;
  }
  /// A node with a mesh of one primitive.
  void add_node(const std::string& name, const Vec3d& shift, Json primitive) {
    json_["meshes"].push_back({{"name", name}, {"primitives", Json::array({std::move(primitive)})}});
    Json node{{"name", name}, {"mesh", json_["meshes"].size() - 1}};
    if (!(shift == Vec3d{})) node["translation"] = triple(shift);
    json_["nodes"].push_back(std::move(node));
  }

  void write(const fs::path& file) {
    Json nodes = Json::array();
    for (std::size_t n = 0; n < json_["nodes"].size(); ++n) nodes.push_back(n);
    json_["scenes"].push_back({{"nodes", nodes}});
    if (!buffer_.empty()) json_["buffers"] = Json::array({{{"byteLength", buffer_.size()}}});
    for (const char* list : {"meshes", "nodes", "materials", "accessors", "bufferViews"})
      if (json_[list].empty()) json_.erase(list);
    if (json_.find("nodes") == json_.end()) json_["scenes"][0].erase("nodes");
    std::string text = json_.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    buffer_.resize((buffer_.size() + 3) / 4 * 4, '\0');
    const std::size_t bytes = 12 + 8 + text.size() + (buffer_.empty() ? 0 : 8 + buffer_.size());
    if (bytes > UINT32_MAX) fail_run("{}: {} bytes are more than a .glb holds (4 GiB)", file.string(), bytes);
    replace_file(file, [&](const fs::path& temporary) {
      ByteSink out(temporary, file);
      const auto number = [&](std::size_t n) { out.value(static_cast<std::uint32_t>(n)); };
      out.text("glTF"), number(2), number(bytes);
      number(text.size()), out.text("JSON"), out.text(text);
      if (!buffer_.empty()) number(buffer_.size()), out.text(std::string_view("BIN\0", 4)), out.text(buffer_);
      out.close();
    });
  }

 private:
  Json json_;
  std::string buffer_;
};

/// A color of a vertex is linear, and multiplied by that of its material, which is white then.
std::size_t white(Document& document, ClipMaterial material) {
  material.name += " in colors";
  material.color = {1, 1, 1};
  return document.add_material(material);
}

/// Attributes that glTF does not know have names that begin with _.
void add_attribute(Document& document, const VertexAttribute& a, Json& to) {
  if (a.width() == 1) {
    to[fmt::format("_{}", upper(a.name))] =
        document.accessor(std::span<const float>(a.values), float_number, "SCALAR", true);
    return;
  }
  std::vector<Vec3f> vectors(a.vertices());
  for (std::size_t i = 0; i < vectors.size(); ++i)
    vectors[i] = {a.values[3 * i], a.values[3 * i + 1], a.values[3 * i + 2]};
  to[a.kind == AttributeKind::color ? "COLOR_0" : fmt::format("_{}", upper(a.name))] =
      document.accessor(std::span<const Vec3f>(vectors), float_number, "VEC3", true);
}

void add_mesh(Document& document, const std::string& name, const TriMesh& mesh, std::size_t material,
              const Vec3d& shift, const VertexAttributes& others = {}) {
  if (mesh.triangles.empty()) return;  // an accessor has one element or more
  Json attributes{{"POSITION", document.positions(mesh.vertices)}};
  if (!mesh.normals.empty())
    attributes["NORMAL"] = document.accessor(std::span(mesh.normals), float_number, "VEC3", true);
  if (!mesh.velocities.empty())
    attributes["_VELOCITY"] = document.accessor(std::span(mesh.velocities), float_number, "VEC3", true);
  for (const VertexAttribute& a : others) add_attribute(document, a, attributes);
  const std::span<const std::uint32_t> corners(mesh.triangles[0].data(), 3 * mesh.triangles.size());
  document.add_node(name, shift,
                    {{"attributes", attributes},
                     {"indices", document.accessor(corners, unsigned_int, "SCALAR", false)},
                     {"material", material},
                     {"mode", int(triangles)}});
}

void add_points(Document& document, const ClipInfo& clip, const ClipFrame& frame, std::size_t material) {
  const ParticleFrame& all = frame.particles;
  std::vector<Vec3f> position, velocity, color;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all.material[i] != material) continue;
    position.push_back(all.position[i]), velocity.push_back(all.velocity[i]);
    if (!frame.colors.empty()) color.push_back(frame.colors[i]);
  }
  if (position.empty()) return;
  Json attributes{{"POSITION", document.positions(position)},
                  {"_VELOCITY", document.accessor(std::span<const Vec3f>(velocity), float_number, "VEC3", true)}};
  std::size_t look = material;
  if (!color.empty()) {
    attributes["COLOR_0"] = document.accessor(std::span<const Vec3f>(color), float_number, "VEC3", true);
    ClipMaterial matter = clip.materials[material];
    matter.ior.reset();  // points are drawn as what is seen, not looked through
    look = white(document, matter);
  }
  document.add_node(clip.materials[material].name, clip.shift,
                    {{"attributes", attributes}, {"material", look}, {"mode", int(points)}});
}

void add_surface(Document& document, const ClipInfo& clip, const ClipFrame& frame, std::size_t m) {
  const auto material = static_cast<std::size_t>(clip.meshed[m]);
  const bool colored = find_attribute(frame.attributes_of(m), "color") != nullptr && !frame.meshes[m].triangles.empty();
  add_mesh(document, clip.mesh_name(m), frame.meshes[m], colored ? white(document, clip.materials[material]) : material,
           clip.shift, frame.attributes_of(m));
}

void add_foam(Document& document, const ClipInfo& clip, const ParticleFrame& foam) {
  if (foam.size() == 0) return;
  const auto scalars = [&](const char* name) {
    return document.accessor(std::span<const float>(foam.columns.at(name)), float_number, "SCALAR", true);
  };
  const Json attributes{
      {"POSITION", document.positions(foam.position)},
      {"_VELOCITY", document.accessor(std::span<const Vec3f>(foam.velocity), float_number, "VEC3", true)},
      {"_RADIUS", scalars("radius")},
      {"_TYPE", scalars("type")}};
  document.add_node(
      clip.foam_look.name, clip.shift,
      {{"attributes", attributes}, {"material", document.add_material(clip.foam_look)}, {"mode", int(points)}});
}

void add_camera(Document& document, const ClipCamera& c) {
  document["cameras"] = Json::array({{{"type", "perspective"},
                                      {"perspective",
                                       {{"yfov", c.fov * std::numbers::pi / 180},
                                        {"aspectRatio", c.aspect},
                                        {"znear", c.far * 1e-4},
                                        {"zfar", c.far}}}}});
  const Vec3d back = -c.forward;  // a camera looks along -z
  document["nodes"].push_back({{"name", "camera"},
                               {"camera", 0},
                               {"matrix",
                                {c.right.x, c.right.y, c.right.z, 0, c.up.x, c.up.y, c.up.z, 0, back.x, back.y, back.z,
                                 0, c.eye.x, c.eye.y, c.eye.z, 1}}});
}

void write_gltf_frame(const ClipInfo& clip, const ClipFrame& frame, const fs::path& folder) {
  Document document(clip);
  for (std::size_t m = 0; m < frame.meshes.size(); ++m) add_surface(document, clip, frame, m);
  if (clip.particles)
    for (std::size_t m = 0; m < clip.materials.size(); ++m) add_points(document, clip, frame, m);
  if (clip.foam) add_foam(document, clip, frame.foam);
  for (std::size_t o = 0; o < clip.objects.size(); ++o)
    add_mesh(document, clip.objects[o].look.name, placed(clip.objects[o], frame.objects[o]),
             document.add_material(clip.objects[o].look), clip.shift);
  if (clip.camera) add_camera(document, *clip.camera);
  document["asset"]["extras"] = {
      {"frame", frame.number}, {"time", clip.time(frame.number)}, {"fps", clip.fps}, {"units", clip.units()}};
  document.write(folder / numbered(clip.name, frame.number, ".glb"));
}

}  // namespace

Format gltf_format() {
  return {"gltf", "a .glb a frame, with materials and a camera", ".glb", true, nullptr, each_frame<write_gltf_frame>};
}

}  // namespace dreampm::exchange
