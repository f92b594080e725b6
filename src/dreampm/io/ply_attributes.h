// Attributes of a mesh's vertices as properties of a PLY file.
#pragma once
#include <string>
#include <vector>

#include "dreampm/geometry/vertex_attributes.h"
#include "dreampm/import/ply_header.h"
#include "dreampm/io/byte_sink.h"

namespace dreampm {

/// The header's lines.
std::string ply_attribute_lines(const VertexAttributes& attributes);
/// The values of a vertex.
void write_ply_attributes(ByteSink& out, const VertexAttributes& attributes, std::size_t vertex);

/// Takes the values of vertices apart.
class PlyAttributeReader {
 public:
  /// `taken`: the numbers of properties that are no attributes.
  PlyAttributeReader(const PlyElement& vertex, const std::vector<std::size_t>& taken);
  void take(const std::vector<double>& values);
  VertexAttributes attributes;

 private:
  struct Columns {
    std::vector<std::size_t> at;  ///< one a component
    bool bytes = false;           ///< a color of 0 to 255
  };
  std::vector<Columns> columns_;
};

}  // namespace dreampm
