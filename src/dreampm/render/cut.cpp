#include "dreampm/render/cut.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

namespace dreampm {
namespace {

/// A point of the cut, in the plane's own coordinates.
struct Point {
  double u = 0, v = 0;
  Vec3f color{};
};

/// Where the plane cuts a triangle: `low` is below `high`. `enters`: +1 where one comes into the
/// body on the way along u, -1 where one leaves it.
struct Edge {
  Point low, high;
  int enters = 0;
  double u_at(double v) const { return low.u + (high.u - low.u) * ((v - low.v) / (high.v - low.v)); }
  Point at(double v) const {
    const auto t = static_cast<float>((v - low.v) / (high.v - low.v));
    return {u_at(v), v, low.color * (1 - t) + high.color * t};
  }
};

class Cutter {
 public:
  Cutter(TriMesh& mesh, std::vector<Vec3f>& colors, const CutPlane& plane)
      : mesh_(mesh), colors_(colors), plane_(plane), has_normals_(mesh.normals.size() == mesh.vertices.size()) {
    const Vec3d n = plane.normal, other = std::fabs(n.y) < 0.9 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0};
    u_ = normalized(cross(other, n));
    v_ = cross(n, u_);
  }

  void cut() {
    mesh_.velocities.clear();
    std::vector<std::array<std::uint32_t, 3>> faces;
    faces.swap(mesh_.triangles);
    for (const auto& f : faces) cut_face(f);
    close();
    forget_unused();
  }

 private:
  double height(std::uint32_t i) const {
    return dot(static_cast<Vec3d>(mesh_.vertices[i]) - plane_.point, plane_.normal);
  }

  std::uint32_t add(const Vec3f& p, const Vec3f& normal, const Vec3f& color) {
    mesh_.vertices.push_back(p);
    if (has_normals_) mesh_.normals.push_back(normal);
    if (!colors_.empty()) colors_.push_back(color);
    return static_cast<std::uint32_t>(mesh_.vertices.size() - 1);
  }

  /// Where the edge from a vertex before the plane to one behind it meets it. Both faces of an edge
  /// ask in this order, and get the same point.
  std::uint32_t crossing(std::uint32_t before, std::uint32_t behind) {
    const double a = height(before), b = height(behind);
    const auto t = static_cast<float>(a / (a - b));
    const auto between = [t](const Vec3f& p, const Vec3f& q) { return p + (q - p) * t; };
    return add(between(mesh_.vertices[before], mesh_.vertices[behind]),
               has_normals_ ? normalized(between(mesh_.normals[before], mesh_.normals[behind])) : Vec3f{},
               colors_.empty() ? Vec3f{} : between(colors_[before], colors_[behind]));
  }

  void cut_face(std::array<std::uint32_t, 3> f) {
    std::array<bool, 3> before{};
    for (std::size_t k = 0; k < 3; ++k) before[k] = height(f[k]) > 0;
    const auto count = std::count(before.begin(), before.end(), true);
    if (count == 3) return;
    if (count == 0) return void(mesh_.triangles.push_back(f));
    // f[0] is the one that differs.
    while (before[0] == before[1] || before[0] == before[2]) {
      std::rotate(f.begin(), f.begin() + 1, f.end());
      std::rotate(before.begin(), before.begin() + 1, before.end());
    }
    const Vec3f a = mesh_.vertices[f[0]], b = mesh_.vertices[f[1]], c = mesh_.vertices[f[2]];
    const Vec3d outward = static_cast<Vec3d>(cross(b - a, c - a));
    const std::uint32_t p = before[0] ? crossing(f[0], f[1]) : crossing(f[1], f[0]),
                        q = before[0] ? crossing(f[0], f[2]) : crossing(f[2], f[0]);
    if (before[0]) {
      mesh_.triangles.push_back({p, f[1], f[2]});
      mesh_.triangles.push_back({p, f[2], q});
    } else {
      mesh_.triangles.push_back({f[0], p, q});
    }
    Edge e{point(p), point(q), dot(outward, u_) < 0 ? 1 : -1};
    if (e.low.v > e.high.v) std::swap(e.low, e.high);
    if (e.low.v < e.high.v) edges_.push_back(e);
  }

  Point point(std::uint32_t i) const {
    const Vec3d p = static_cast<Vec3d>(mesh_.vertices[i]) - plane_.point;
    return {dot(p, u_), dot(p, v_), colors_.empty() ? Vec3f{} : colors_[i]};
  }

  /// Sweeps along v over the strips between the ends of edges. In each the body lies between pairs
  /// of edges; a pair that goes on in the next strip makes one face with it.
  void close() {
    std::vector<double> levels;
    for (const Edge& e : edges_) levels.push_back(e.low.v), levels.push_back(e.high.v);
    std::sort(levels.begin(), levels.end());
    levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
    std::sort(edges_.begin(), edges_.end(), [](const Edge& a, const Edge& b) { return a.low.v < b.low.v; });
    using Pair = std::pair<const Edge*, const Edge*>;
    std::vector<std::pair<Pair, double>> open;  // with where it began
    std::vector<const Edge*> active;
    std::size_t next = 0;
    for (std::size_t k = 0; k + 1 < levels.size(); ++k) {
      const double low = levels[k], high = levels[k + 1], middle = 0.5 * (low + high);
      std::erase_if(active, [&](const Edge* e) { return e->high.v <= low; });
      for (; next < edges_.size() && edges_[next].low.v <= low; ++next) active.push_back(&edges_[next]);
      std::stable_sort(active.begin(), active.end(),
                       [&](const Edge* a, const Edge* b) { return a->u_at(middle) < b->u_at(middle); });
      std::vector<std::pair<Pair, double>> now;
      int inside = 0;
      const Edge* left = nullptr;
      for (const Edge* e : active) {
        const int was = inside;
        inside += e->enters;
        if (was == 0) left = e;
        if (inside != 0 || left == nullptr) continue;
        const Pair pair{left, e};
        const auto known = std::find_if(open.begin(), open.end(), [&](const auto& o) { return o.first == pair; });
        now.emplace_back(pair, known == open.end() ? low : known->second);
        if (known != open.end()) open.erase(known);
      }
      for (const auto& [pair, from] : open) fill(*pair.first, *pair.second, from, low);
      open = std::move(now);
    }
    for (const auto& [pair, from] : open) fill(*pair.first, *pair.second, from, levels.back());
  }

  void fill(const Edge& left, const Edge& right, double low, double high) {
    const auto corner = [&](const Point& p) {
      return add(static_cast<Vec3f>(plane_.point + u_ * p.u + v_ * p.v), static_cast<Vec3f>(plane_.normal), p.color);
    };
    const std::uint32_t a = corner(left.at(low)), b = corner(right.at(low)), c = corner(right.at(high)),
                        d = corner(left.at(high));
    mesh_.triangles.push_back({a, b, c});
    mesh_.triangles.push_back({a, c, d});
  }

  /// Vertices before the plane must not stretch the bounds of the picture.
  void forget_unused() {
    constexpr std::uint32_t unused = ~0u;
    std::vector<std::uint32_t> to(mesh_.vertices.size(), unused);
    for (const auto& f : mesh_.triangles)
      for (const std::uint32_t v : f) to[v] = 0;
    std::uint32_t n = 0;
    for (std::size_t v = 0; v < to.size(); ++v) {
      if (to[v] == unused) continue;
      mesh_.vertices[n] = mesh_.vertices[v];
      if (has_normals_) mesh_.normals[n] = mesh_.normals[v];
      if (!colors_.empty()) colors_[n] = colors_[v];
      to[v] = n++;
    }
    mesh_.vertices.resize(n);
    if (has_normals_) mesh_.normals.resize(n);
    if (!colors_.empty()) colors_.resize(n);
    for (auto& f : mesh_.triangles)
      for (std::uint32_t& v : f) v = to[v];
  }

  TriMesh& mesh_;
  std::vector<Vec3f>& colors_;
  CutPlane plane_;
  bool has_normals_;
  Vec3d u_, v_;
  std::vector<Edge> edges_;
};

}  // namespace

void cut_mesh(TriMesh& mesh, std::vector<Vec3f>& colors, const CutPlane& plane) { Cutter(mesh, colors, plane).cut(); }

void cut_points(std::vector<Vec3f>& points, std::initializer_list<std::vector<Vec3f>*> theirs, const CutPlane& plane) {
  std::size_t n = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (plane.before(points[i])) continue;
    points[n] = points[i];
    for (std::vector<Vec3f>* values : theirs)
      if (!values->empty()) (*values)[n] = (*values)[i];
    ++n;
  }
  points.resize(n);
  for (std::vector<Vec3f>* values : theirs)
    if (!values->empty()) values->resize(n);
}

}  // namespace dreampm
