// The header of a PLY file: what every reader of such files, meshes, clouds and particles, goes by.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace dreampm {

enum class PlyFormat { ascii, binary_little_endian, binary_big_endian };
enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// Bytes of one value.
std::size_t ply_size(PlyType type);
/// The name as a header writes it: "char", "uchar", "short", "ushort", "int", "uint", "float",
/// "double".
const char* ply_name(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;  ///< of the value, or of each item of a list
  bool list = false;
  PlyType count_type = PlyType::uint8;  ///< of a list's length
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  /// The property of this name, or null.
  const PlyProperty* find(std::string_view property) const;
  bool has_list() const;
  /// The list of this element that names vertices (vertex_indices or vertex_index), or null.
  const PlyProperty* corners() const;
  /// Bytes of one row in a binary file; a list counts as its length field alone.
  std::size_t row_bytes() const;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;
  std::vector<std::string> comments;  ///< without the word "comment"
  std::uint64_t data_offset = 0;      ///< of the first byte after the header
  std::uint64_t file_bytes = 0;       ///< unpacked

  /// The element of this name, or null.
  const PlyElement* find(std::string_view element) const;
  /// True if some element, face or strip, joins vertices: a mesh, no cloud.
  bool has_faces() const;
};

/// Reads and checks the header at the start of `text`, which is the whole unpacked file: magic,
/// format 1.0, known types, no duplicate names, and counts that the size of the file allows, so
/// that nothing is allocated for an absurd count. Lines may end with LF, CRLF or CR and with
/// blanks; comments and obj_info may stand anywhere; a byte order mark is skipped. `name` is for
/// messages. Throws InputError naming the file, the line and what is wrong.
PlyHeader parse_ply_header(std::string_view text, const std::string& name);

/// The same of a file, which may be packed with gzip.
PlyHeader read_ply_header(const std::filesystem::path& file);

/// Garbage in a message must not reach the terminal as control characters, nor fill it.
std::string printable(std::string_view text);

}  // namespace dreampm
