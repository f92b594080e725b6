// What a glTF file promises and requires. The importer drops faces with indices out of range
// without a word, and reads quantized or compressed positions as if they were floats.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace dreampm {

/// How many triangles the meshes of the scene in a .gltf or .glb file have together, each mesh
/// counted once; nothing if that cannot be read (strips, compressed geometry, no scene). `name` is
/// for messages. Throws InputError if the file is cut short or its JSON is broken.
std::optional<std::size_t> gltf_triangles(std::string_view text, const std::string& name);

/// The same file, with a scene of all of its nodes, or meshes, where it has none: that is allowed,
/// and readers refuse it.
std::string with_scene(std::string text, const std::string& name);

/// Throws InputError, naming the extension and the remedy, if the file requires one that changes
/// where its vertices are and that is not read, or has positions that are compressed or quantized
/// without saying so. Extensions of materials, textures and lights concern nothing that is taken
/// from the file.
void check_gltf(std::string_view text, const std::string& name);

}  // namespace dreampm
