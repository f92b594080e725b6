// A triangle mesh as plain arrays.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "dreampm/vec.h"

namespace dreampm {

struct TriMesh {
  std::vector<Vec3f> vertices;                          ///< m
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise seen from outside
  std::vector<Vec3f> normals;                           ///< per vertex, or empty
  std::vector<Vec3f> velocities;                        ///< per vertex, m/s, or empty
};

}  // namespace dreampm
