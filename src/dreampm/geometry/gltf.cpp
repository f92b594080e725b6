#include "dreampm/geometry/gltf.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "dreampm/base/error.h"

namespace dreampm {
namespace {
using Json = nlohmann::json;

/// The JSON of a .glb is its first chunk; a .gltf is JSON throughout.
std::string_view json_part(std::string_view text, const std::string& name) {
  constexpr std::size_t head = 12, chunk_head = 8;
  if (!text.starts_with("glTF")) return text;
  std::uint32_t length = 0;
  if (text.size() >= head + chunk_head) std::memcpy(&length, text.data() + head, sizeof length);
  if (text.size() < head + chunk_head + length)
    fail_input("{}: cannot be read as a mesh: it is cut short after {} bytes", name, text.size());
  return text.substr(head + chunk_head, length);
}

/// The same file with another JSON.
std::string with_json(std::string_view text, const std::string& json) {
  if (!text.starts_with("glTF")) return json;
  constexpr std::size_t head = 12, chunk_head = 8;
  std::uint32_t old = 0;
  std::memcpy(&old, text.data() + head, sizeof old);
  std::string padded = json;
  padded.resize((padded.size() + 3) / 4 * 4, ' ');
  const std::string_view rest = text.substr(head + chunk_head + old);
  const auto length = static_cast<std::uint32_t>(padded.size()),
             all = static_cast<std::uint32_t>(head + chunk_head + padded.size() + rest.size());
  std::string out(text.substr(0, head + chunk_head));
  std::memcpy(out.data() + 8, &all, sizeof all);
  std::memcpy(out.data() + head, &length, sizeof length);
  return out.append(padded).append(rest);
}

/// The meshes that the nodes of the scene name.
std::set<std::size_t> meshes_of_scene(const Json& file) {
  std::set<std::size_t> meshes, seen;
  std::vector<std::size_t> open = file.at("scenes").at(file.value("scene", std::size_t{0})).at("nodes");
  while (!open.empty()) {
    const std::size_t at = open.back();
    open.pop_back();
    if (!seen.insert(at).second) continue;
    const Json& node = file.at("nodes").at(at);
    if (node.contains("mesh")) meshes.insert(node.at("mesh").get<std::size_t>());
    if (node.contains("children"))
      for (const std::size_t child : node.at("children")) open.push_back(child);
  }
  return meshes;
}

/// Whether an extension leaves the triangles of a file as they are.
bool looks_only(std::string_view extension) {
  constexpr std::string_view prefixes[] = {"KHR_materials_",   "KHR_texture_", "EXT_texture_", "MSFT_texture_",
                                           "ADOBE_materials_", "KHR_lights_",  "EXT_lights_",  "KHR_xmp"};
  return std::any_of(std::begin(prefixes), std::end(prefixes), [&](auto p) { return extension.starts_with(p); });
}

std::string remedy(std::string_view extension) {
  if (extension.find("compression") != extension.npos) return "export it without compression";
  if (extension.find("quantization") != extension.npos) return "export it without quantization";
  return "export it without that extension";
}

[[noreturn]] void fail_unread(const std::string& name, const std::string& extension) {
  fail_input("{}: uses {}, which is not read; {}", name, extension, remedy(extension));
}

/// The items of a list; none where there is no such list.
Json list_of(const Json& object, const char* key) {
  if (!object.is_object() || !object.contains(key) || !object[key].is_array()) return Json::array();
  return object[key];
}

/// The accessor of the positions of a primitive, or null.
const Json* positions_of(const Json& file, const Json& part) {
  if (!part.is_object() || !part.contains("attributes") || !part["attributes"].is_object()) return nullptr;
  const Json& attributes = part["attributes"];
  if (!attributes.contains("POSITION") || !attributes["POSITION"].is_number_unsigned()) return nullptr;
  const auto index = attributes["POSITION"].get<std::size_t>();
  if (!file.contains("accessors") || !file["accessors"].is_array() || index >= file["accessors"].size()) return nullptr;
  const Json& accessor = file["accessors"][index];
  const bool usable =
      accessor.is_object() && accessor.contains("componentType") && accessor["componentType"].is_number_integer();
  return usable ? &accessor : nullptr;
}

}  // namespace

void check_gltf(std::string_view text, const std::string& name) {
  const Json file = Json::parse(json_part(text, name), nullptr, false);
  if (!file.is_object()) return;  // gltf_triangles says what is wrong
  for (const Json& required : list_of(file, "extensionsRequired"))
    if (required.is_string() && !looks_only(required.get<std::string>())) fail_unread(name, required);
  for (const Json& buffer : list_of(file, "buffers"))
    for (const char* extension : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
      if (buffer.contains("extensions") && buffer["extensions"].contains(extension) && !buffer.contains("uri"))
        fail_unread(name, extension);
  for (const Json& mesh : list_of(file, "meshes"))
    for (const Json& part : list_of(mesh, "primitives")) {
      const Json* const positions = positions_of(file, part);
      if (!positions) continue;
      constexpr const char* draco = "KHR_draco_mesh_compression";
      if (part.contains("extensions") && part["extensions"].contains(draco) && !positions->contains("bufferView"))
        fail_unread(name, draco);
      constexpr int whole_numbers_end = 5125;  // GL_BYTE to GL_UNSIGNED_INT
      if (positions->value("componentType", 0) <= whole_numbers_end) fail_unread(name, "KHR_mesh_quantization");
    }
}

std::string with_scene(std::string text, const std::string& name) {
  Json file = Json::parse(json_part(text, name), nullptr, false);
  if (!file.is_object() || !list_of(file, "scenes").empty()) return text;
  Json nodes = list_of(file, "nodes");
  if (nodes.empty())
    for (std::size_t m = 0; m < list_of(file, "meshes").size(); ++m) nodes.push_back({{"mesh", m}});
  std::set<std::size_t> children;
  for (const Json& node : nodes)
    for (const Json& child : list_of(node, "children"))
      if (child.is_number_unsigned()) children.insert(child.get<std::size_t>());
  Json roots = Json::array();
  for (std::size_t n = 0; n < nodes.size(); ++n)
    if (!children.contains(n)) roots.push_back(n);
  if (roots.empty()) return text;
  file["nodes"] = std::move(nodes);
  file["scenes"] = Json::array({Json{{"nodes", std::move(roots)}}});
  file["scene"] = 0;
  return with_json(text, file.dump());
}

std::optional<std::size_t> gltf_triangles(std::string_view text, const std::string& name) {
  constexpr int points = 0, lines_end = 3, triangles = 4;
  try {
    const Json file = Json::parse(json_part(text, name));
    std::size_t count = 0;
    for (const std::size_t m : meshes_of_scene(file))
      for (const Json& part : file.at("meshes").at(m).at("primitives")) {
        const int mode = part.value("mode", triangles);
        if (mode >= points && mode <= lines_end) continue;
        if (mode != triangles || part.contains("extensions")) return std::nullopt;
        const Json& accessor = part.contains("indices") ? part.at("indices") : part.at("attributes").at("POSITION");
        count += file.at("accessors").at(accessor.get<std::size_t>()).at("count").get<std::size_t>() / 3;
      }
    return count;
  } catch (const Json::parse_error& e) {
    fail_input("{}: cannot be read as a mesh: its JSON is broken or cut short at byte {}", name, e.byte);
  } catch (const Json::exception&) {
    return std::nullopt;  // another layout than the format's: the importer judges it
  }
}

}  // namespace dreampm
