// What a mesh knows of its vertices beside places, normals and velocities.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace dreampm {

enum class AttributeKind {
  number,
  whole,   ///< whole numbers of at most 24 bits
  vector,  ///< three numbers, which turn with the mesh
  color    ///< three numbers, linear, 0 to 1
};

struct VertexAttribute {
  std::string name;
  AttributeKind kind = AttributeKind::number;
  std::vector<float> values;  ///< width() a vertex, one vertex after the other

  std::size_t width() const { return kind == AttributeKind::vector || kind == AttributeKind::color ? 3 : 1; }
  std::size_t vertices() const { return values.size() / width(); }
};

using VertexAttributes = std::vector<VertexAttribute>;

/// Null if there is none of that name.
inline const VertexAttribute* find_attribute(const VertexAttributes& all, const std::string& name) {
  for (const VertexAttribute& a : all)
    if (a.name == name) return &a;
  return nullptr;
}

}  // namespace dreampm
