// What a glTF file promises, to hold the importer to: it drops faces with indices out of range without a word.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace dreampm {

/// How many triangles the meshes of the scene in a .gltf or .glb file have together, each mesh counted once; nothing if
/// that cannot be told (strips, compressed geometry, no scene). `name` is for messages. Throws InputError if the file
/// is cut short or its JSON is broken.
std::optional<std::size_t> gltf_triangles(std::string_view text, const std::string& name);

}  // namespace dreampm
