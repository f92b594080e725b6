// The JSON of a glTF file: its values with the way to each, for messages, and what it requires.
#pragma once
#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace dreampm {

/// A .gltf file is JSON throughout; a .glb file has it as its first chunk, and then the bytes of
/// its first buffer.
struct GltfParts {
  nlohmann::json json;
  std::optional<std::string_view> bytes;  ///< of `text`
};

/// Throws InputError naming the file: cut short, broken, of another version, or its lists lie
/// deeper in one another than in any file of the format.
GltfParts gltf_parts(std::string_view text, const std::string& name);

/// Throws InputError, naming the extension and the remedy, if the file requires one that changes
/// where its vertices are and that is not read, or has positions that are compressed or quantized
/// without saying so. Extensions of materials, textures and lights concern nothing that is taken
/// from the file.
void check_gltf_extensions(const nlohmann::json& file, const std::string& name);

/// A value, and where it stands. What is missing or of another kind is refused with that place.
class GltfValue {
 public:
  /// `name` is that of the file, and must outlive this object, as `json` must.
  GltfValue(const nlohmann::json& json, const std::string& name, std::string way = {})
      : json_(json), name_(name), way_(std::move(way)) {}

  bool has(const char* key) const;
  GltfValue at(const char* key) const;
  GltfValue at(std::size_t i) const;
  /// Returns the length of a list.
  std::size_t size() const;
  /// A whole number from 0 on; `otherwise` where there is no such key.
  std::size_t count(const char* key, std::optional<std::size_t> otherwise = std::nullopt) const;
  std::size_t as_count() const;
  std::string text(const char* key) const;
  /// Returns as many numbers as `otherwise` has, which is the result where there is no such key.
  std::vector<double> numbers(const char* key, std::vector<double> otherwise) const;
  [[noreturn]] void refuse(const std::string& why) const;

 private:
  const nlohmann::json& json_;
  const std::string& name_;
  std::string way_;
};

}  // namespace dreampm
