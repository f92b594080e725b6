// Eigenvectors of a symmetric 3x3 matrix by cyclic Jacobi rotations (Golub and Van Loan, "Matrix
// Computations", 8.5).
#pragma once
#include <array>
#include <utility>

#include "dreampm/math/mat3.h"

namespace dreampm::surface {

/// Ascending eigenvalues and, as columns of `axes`, unit eigenvectors.
struct Eigen3 {
  std::array<float, 3> values;
  Mat3f axes;
};

inline Eigen3 eigen(const Sym3<float>& sym) {
  Mat3f a = sym.full(), v = Mat3f::identity();
  for (int sweep = 0; sweep < 6; ++sweep)
    for (int p = 0; p < 2; ++p)
      for (int q = p + 1; q < 3; ++q) {
        if (a(p, q) == 0) continue;
        const float theta = (a(q, q) - a(p, p)) / (2 * a(p, q));
        // A huge theta overflows to t = 0: the element is negligible already.
        const float t = (theta >= 0 ? 1.0f : -1.0f) / (std::abs(theta) + std::sqrt(theta * theta + 1));
        const float c = 1 / std::sqrt(t * t + 1), s = t * c;
        for (int k = 0; k < 3; ++k) {
          const float x = a(k, p), y = a(k, q);
          a(k, p) = c * x - s * y, a(k, q) = s * x + c * y;
        }
        for (int k = 0; k < 3; ++k) {
          const float x = a(p, k), y = a(q, k);
          a(p, k) = c * x - s * y, a(q, k) = s * x + c * y;
        }
        for (int k = 0; k < 3; ++k) {
          const float x = v(k, p), y = v(k, q);
          v(k, p) = c * x - s * y, v(k, q) = s * x + c * y;
        }
      }
  std::array<int, 3> order{0, 1, 2};
  const auto sort = [&](int i, int j) {
    auto &x = order[static_cast<std::size_t>(i)], &y = order[static_cast<std::size_t>(j)];
    if (a(y, y) < a(x, x)) std::swap(x, y);
  };
  sort(0, 1), sort(1, 2), sort(0, 1);
  Eigen3 e;
  for (int i = 0; i < 3; ++i) {
    const int from = order[static_cast<std::size_t>(i)];
    e.values[static_cast<std::size_t>(i)] = a(from, from);
    for (int k = 0; k < 3; ++k) e.axes(k, i) = v(k, from);
  }
  return e;
}

}  // namespace dreampm::surface
