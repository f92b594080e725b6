#include "validate/revolve.h"

#include <cmath>
#include <numbers>

namespace dreampm::validate {

TriMesh revolved(const std::vector<ProfilePoint>& profile, const Vec3d& foot, int steps) {
  TriMesh mesh;
  const auto n = static_cast<std::uint32_t>(profile.size()), turns = static_cast<std::uint32_t>(steps);
  for (std::uint32_t s = 0; s < turns; ++s) {
    const double a = 2 * std::numbers::pi * s / turns;
    for (const ProfilePoint& p : profile)
      mesh.vertices.push_back(
          static_cast<Vec3f>(foot + Vec3d{p.radius * std::cos(a), p.height, p.radius * std::sin(a)}));
  }
  for (std::uint32_t s = 0; s < turns; ++s)
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t j = (i + 1) % n, here = s * n, next = (s + 1) % turns * n;
      // An edge that ends on the axis sweeps triangles, and one that lies on it nothing.
      if (profile[i].radius > 0) mesh.triangles.push_back({here + i, here + j, next + i});
      if (profile[j].radius > 0) mesh.triangles.push_back({next + i, here + j, next + j});
    }
  return mesh;
}

}  // namespace dreampm::validate
