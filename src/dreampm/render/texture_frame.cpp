#include "dreampm/render/texture_frame.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "dreampm/math/symmetric_function.h"

namespace dreampm {
namespace {

/// Spreads that differ by less are taken to be equal.
constexpr double alike = 0.02;

/// v of the projector v v^T: its longest column.
Vec3d axis_of(const Sym3<double>& p) {
  const Vec3d columns[3] = {{p.xx, p.xy, p.xz}, {p.xy, p.yy, p.yz}, {p.xz, p.yz, p.zz}};
  return normalized(
      *std::max_element(columns, columns + 3, [](const Vec3d& a, const Vec3d& b) { return length2(a) < length2(b); }));
}

/// Any of the picture's axes that is square enough to v, made square to it.
Vec3d square_to(const Vec3d& v) {
  const Vec3d other = std::fabs(v.z) < 0.7 ? Vec3d{0, 0, 1} : Vec3d{0, 1, 0};
  return normalized(other - v * dot(v, other));
}

/// The longest way and the thinnest way of the faces, by area.
std::pair<Vec3d, Vec3d> long_and_thin(const TriMesh& mesh) {
  double area = 0;
  Vec3d mean{};
  Sym3<double> square{};
  for (const auto& [i, j, k] : mesh.triangles) {
    const auto a = static_cast<Vec3d>(mesh.vertices[i]), b = static_cast<Vec3d>(mesh.vertices[j]),
               c = static_cast<Vec3d>(mesh.vertices[k]), sum = a + b + c;
    const double weight = length(cross(b - a, c - a)) / 2;
    area += weight;
    mean += sum * (weight / 3);
    // The mean of x x^T over a triangle is that over its corners and three times its middle, by 12.
    const auto add = [&](const Vec3d& x, double w) {
      square.xx += w * x.x * x.x, square.yy += w * x.y * x.y, square.zz += w * x.z * x.z;
      square.xy += w * x.x * x.y, square.xz += w * x.x * x.z, square.yz += w * x.y * x.z;
    };
    for (const Vec3d& x : {a, b, c, sum}) add(x, weight / 12);
  }
  if (!(area > 0)) return {{1, 0, 0}, {0, 0, 1}};
  mean = mean / area;
  square = square * (1 / area);
  square.xx -= mean.x * mean.x, square.yy -= mean.y * mean.y, square.zz -= mean.z * mean.z;
  square.xy -= mean.x * mean.y, square.xz -= mean.x * mean.z, square.yz -= mean.y * mean.z;
  const Spectrum3<double> s = spectrum_of(square);
  const double most = std::max(s.apart, s.other), least = std::min(s.apart, s.other);
  if (!(most - least > alike * most)) return {{1, 0, 0}, {0, 0, 1}};
  const Vec3d apart = axis_of(s.along);
  // The other two are alike: any two square axes will do.
  if (!(std::fabs(s.middle - s.other) > alike * most)) {
    const Vec3d square_axis = square_to(apart);
    return s.apart > s.other ? std::pair{apart, square_axis} : std::pair{square_axis, apart};
  }
  const Sym3<double> both{1 - s.along.xx, 1 - s.along.yy, 1 - s.along.zz, -s.along.xy, -s.along.xz, -s.along.yz};
  const Vec3d other = axis_of({both.xx - s.plane.xx, both.yy - s.plane.yy, both.zz - s.plane.zz, both.xy - s.plane.xy,
                               both.xz - s.plane.xz, both.yz - s.plane.yz});
  return s.apart > s.other ? std::pair{apart, other} : std::pair{other, apart};
}

}  // namespace

TextureFrame texture_frame(const TriMesh& mesh, const std::optional<Vec3f>& grain) {
  auto [along, thin] = long_and_thin(mesh);
  if (grain) along = normalized(static_cast<Vec3d>(*grain));
  thin = thin - along * dot(along, thin);
  thin = length(thin) > 1e-3 ? normalized(thin) : square_to(along);
  TextureFrame frame;
  frame.x = static_cast<Vec3f>(along);
  frame.z = static_cast<Vec3f>(thin);
  frame.y = cross(frame.z, frame.x);
  constexpr float most = std::numeric_limits<float>::max();
  Vec3f low{most, most, most}, high = -low;
  for (const Vec3f& v : mesh.vertices) {
    const Vec3f q{dot(v, frame.x), dot(v, frame.y), dot(v, frame.z)};
    low = min(low, q), high = max(high, q);
  }
  if (mesh.vertices.empty()) return frame;
  const Vec3f middle = (low + high) * 0.5f;
  frame.half = (high - low) * 0.5f;
  frame.middle = frame.x * middle.x + frame.y * middle.y + frame.z * middle.z;
  return frame;
}

}  // namespace dreampm
