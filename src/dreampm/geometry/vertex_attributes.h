// What a mesh knows of its vertices beside places, normals and velocities.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "dreampm/math/vec.h"

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

/// Values of vectors, one vector after the other, as an attribute keeps them.
inline std::vector<float> flat(const std::vector<Vec3f>& vectors) {
  std::vector<float> values;
  values.reserve(3 * vectors.size());
  for (const Vec3f& v : vectors) values.insert(values.end(), {v.x, v.y, v.z});
  return values;
}

/// Null if there is none of that name.
inline const VertexAttribute* find_attribute(const VertexAttributes& all, const std::string& name) {
  for (const VertexAttribute& a : all)
    if (a.name == name) return &a;
  return nullptr;
}

}  // namespace dreampm
