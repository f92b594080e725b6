#include "dreampm/import/gltf_json.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "dreampm/base/error.h"

namespace dreampm {
namespace {
using Json = nlohmann::json;

/// Throws InputError where lists in lists are deeper than in any file of the format, as readers of
/// JSON recurse.
void check_depth(std::string_view json, const std::string& name) {
  constexpr int most = 100;
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (quoted && c == '\\') ++i;
    if (c == '"') quoted = !quoted;
    if (quoted) continue;
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
    if (depth > most)
      fail_input("{}: cannot be read as a mesh: its JSON is more than {} lists deep, at byte {}", name, most, i);
  }
}

/// A chunk of a .glb file begins with its length and what it is.
std::string_view take_chunk(std::string_view& rest, std::string_view text, const std::string& name) {
  constexpr std::size_t head = 8;
  std::uint32_t length = 0;
  if (rest.size() >= head) std::memcpy(&length, rest.data(), sizeof length);
  if (rest.size() < head || length > rest.size() - head)
    fail_input("{}: cannot be read as a mesh: it is cut short after {} bytes", name, text.size());
  const std::string_view chunk = rest.substr(head, length);
  rest.remove_prefix(head + length);
  return chunk;
}

/// True if an extension leaves the triangles of a file as they are.
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
const Json& list_of(const Json& object, const char* key) {
  static const Json none = Json::array();
  if (!object.is_object() || !object.contains(key) || !object[key].is_array()) return none;
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

bool has_extension(const Json& object, const char* extension) {
  return object.is_object() && object.contains("extensions") && object["extensions"].contains(extension);
}

}  // namespace

GltfParts gltf_parts(std::string_view text, const std::string& name) {
  GltfParts out;
  std::string_view json = text;
  if (text.starts_with("glTF")) {
    constexpr std::size_t head = 12;
    std::string_view rest = text.substr(std::min(head, text.size()));
    json = take_chunk(rest, text, name);
    if (!rest.empty()) out.bytes = take_chunk(rest, text, name);
  }
  check_depth(json, name);
  try {
    out.json = Json::parse(json);
  } catch (const Json::parse_error& e) {
    fail_input("{}: cannot be read as a mesh: its JSON is broken or cut short at byte {}", name, e.byte);
  } catch (const Json::exception&) {
    fail_input("{}: cannot be read as a mesh: a number of its JSON is beyond what a double holds", name);
  }
  const GltfValue file(out.json, name);
  if (!file.has("asset")) file.refuse("it has no asset, which names the version of glTF");
  if (const std::string version = file.at("asset").text("version"); !version.starts_with("2."))
    file.at("asset").refuse(fmt::format("is of version {:.20}; 2.0 is read", version));
  return out;
}

void check_gltf_extensions(const Json& file, const std::string& name) {
  for (const Json& required : list_of(file, "extensionsRequired"))
    if (required.is_string() && !looks_only(required.get<std::string>())) fail_unread(name, required);
  for (const Json& buffer : list_of(file, "buffers"))
    for (const char* extension : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
      if (has_extension(buffer, extension) && !buffer.contains("uri")) fail_unread(name, extension);
  for (const Json& mesh : list_of(file, "meshes"))
    for (const Json& part : list_of(mesh, "primitives")) {
      const Json* const positions = positions_of(file, part);
      if (!positions) continue;
      constexpr const char* draco = "KHR_draco_mesh_compression";
      if (has_extension(part, draco) && !positions->contains("bufferView")) fail_unread(name, draco);
      constexpr std::int64_t whole_numbers_end = 5125;  // GL_BYTE to GL_UNSIGNED_INT
      if ((*positions)["componentType"].get<std::int64_t>() <= whole_numbers_end)
        fail_unread(name, "KHR_mesh_quantization");
    }
}

bool GltfValue::has(const char* key) const {
  if (!json_.is_object()) refuse("must be an object");
  return json_.contains(key);
}

GltfValue GltfValue::at(const char* key) const {
  if (!has(key)) refuse(fmt::format("lacks {}", key));
  return {json_[key], name_, way_.empty() ? key : way_ + "." + key};
}

GltfValue GltfValue::at(std::size_t i) const {
  if (i >= size()) refuse(fmt::format("has {} entries, and number {} of them is named", size(), i));
  return {json_[i], name_, fmt::format("{}[{}]", way_, i)};
}

std::size_t GltfValue::size() const {
  if (!json_.is_array()) refuse("must be a list");
  return json_.size();
}

std::size_t GltfValue::as_count() const {
  constexpr std::size_t most = std::size_t(1) << 53;
  const bool is = json_.is_number_unsigned() && json_.get<std::size_t>() <= most;
  if (!is) refuse(json_.is_number() ? json_.dump() + " is no whole number from 0 on" : "must be a number");
  return json_.get<std::size_t>();
}

std::size_t GltfValue::count(const char* key, std::optional<std::size_t> otherwise) const {
  return otherwise && !has(key) ? *otherwise : at(key).as_count();
}

std::string GltfValue::text(const char* key) const {
  const GltfValue of = at(key);
  if (!of.json_.is_string()) of.refuse("must be a text");
  return of.json_.get<std::string>();
}

std::vector<double> GltfValue::numbers(const char* key, std::vector<double> otherwise) const {
  if (!has(key)) return otherwise;
  const GltfValue list = at(key);
  if (list.size() != otherwise.size())
    list.refuse(fmt::format("has {} numbers, {} are wanted", list.size(), otherwise.size()));
  for (std::size_t i = 0; i < otherwise.size(); ++i) {
    if (!list.json_[i].is_number()) list.at(i).refuse("must be a number");
    otherwise[i] = list.json_[i].get<double>();
  }
  return otherwise;
}

void GltfValue::refuse(const std::string& why) const {
  fail_input("{}: cannot be read as a mesh: {}{}{}", name_, way_, way_.empty() ? "" : ": ", why);
}

}  // namespace dreampm
