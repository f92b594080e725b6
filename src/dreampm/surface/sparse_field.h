// A scalar field on a regular grid, stored only near the surface: leaves of 8x8x8 points, the rest
// is one of two constants.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "dreampm/math/vec.h"

namespace dreampm {

/// Grid point (i, j, k) lies at origin + voxel * (i, j, k). Leaf (a, b, c) holds points 8a..8a+7,
/// ..., x fastest. Outside of every stored leaf the field is 1 within the leaves listed in
/// `inside`, 0 elsewhere.
struct SparseField {
  static constexpr int kWidth = 8;                          ///< points along one axis of a leaf
  static constexpr int kPoints = kWidth * kWidth * kWidth;  ///< points of a leaf

  Vec3f origin;               ///< m
  float voxel = 0;            ///< m
  float iso = 0.5f;           ///< the surface is where the field has this value; larger inside
  std::vector<Vec3i> leaves;  ///< ordered by z, y, x
  std::vector<Vec3i> inside;  ///< leaves without values, wholly inside; in the same order
  std::vector<float> values;  ///< kPoints for each of `leaves`

  std::span<float> leaf(std::size_t i) { return std::span(values).subspan(i * kPoints, kPoints); }
  std::span<const float> leaf(std::size_t i) const { return std::span(values).subspan(i * kPoints, kPoints); }
  Vec3f point(const Vec3i& index) const { return origin + Vec3f(index) * voxel; }
};

}  // namespace dreampm
