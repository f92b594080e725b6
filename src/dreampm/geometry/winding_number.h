// The generalized winding number of a triangle mesh: how often it wraps around a point, also where
// it has holes.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "dreampm/geometry/mesh.h"

namespace dreampm {

/// Fast winding numbers (Barill, Dickson, Schmidt, Levin, Jacobson 2018): a tree over the triangles
/// whose far nodes act as dipoles with their first and second moments, and whose near leaves are
/// summed exactly by solid angles (van Oosterom and Strackee 1983). Immutable once built; ask from
/// any number of threads.
class WindingNumber {
 public:
  /// Keeps its own copy of the triangles. Indices must be in range and vertices finite. O(n log n).
  explicit WindingNumber(const TriMesh& mesh);

  /// 1 deep inside a closed mesh, 0 far outside, between them near holes, about 1/2 on the surface.
  /// The error of the expansion stays below 0.01 (tested).
  double operator()(const Vec3d& p) const;

 private:
  struct Node {
    Vec3d center;                  ///< area-weighted
    double reach2;                 ///< (beta * radius)^2: further than this, the expansion is used
    Vec3d dipole;                  ///< integral of n dA
    double trace;                  ///< of o.n dA, o the offset from the center
    std::array<double, 6> square;  ///< (o.r)(n.r) dA as a form in r: xx yy zz xy xz yz
    Vec3d second;                  ///< of 2 (o.n) o + |o|^2 n dA
    std::array<double, 10> cubic;  ///< (o.r)^2 (n.r) dA: xxx yyy zzz xxy xxz yyx yyz zzx zzy xyz
    std::uint32_t begin, end;      ///< triangles
    std::uint32_t right;           ///< second child; the first is the next node; 0: a leaf
    void add(const Vec3d& o, const Vec3d& n);
    double far_field(const Vec3d& r, double d2) const;
  };
  struct Triangle {
    Vec3f a, b, c;
  };
  std::uint32_t build(std::vector<std::uint32_t>& order, std::uint32_t begin, std::uint32_t end, const TriMesh& mesh);
  std::vector<Node> nodes_;
  std::vector<Triangle> triangles_;
};

}  // namespace dreampm
