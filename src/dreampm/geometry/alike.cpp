#include "dreampm/geometry/alike.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace dreampm {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

/// One side of a triangle, from its lower to its higher vertex.
struct Side {
  std::uint32_t low, high, face;
  bool forward;  ///< true if the triangle goes from low to high
  std::uint8_t corner;
};

/// The face on the other side of an edge of two faces.
struct Link {
  std::uint32_t face = none;
  bool differs = false;  ///< both go along the edge the same way, so one of them looks the wrong way
};
using Links = std::vector<std::array<Link, 3>>;

Links link_faces(const Model& model, Alike& found) {
  const std::vector<std::uint32_t> vertex = by_place(model.vertices);
  std::vector<Side> sides;
  sides.reserve(3 * model.triangles.size());
  for (std::uint32_t f = 0; f < model.triangles.size(); ++f)
    for (std::uint8_t k = 0; k < 3; ++k) {
      const std::uint32_t a = vertex[model.triangles[f][k]], b = vertex[model.triangles[f][(k + 1) % 3]];
      if (a != b) sides.push_back({std::min(a, b), std::max(a, b), f, a < b, k});
    }
  const auto key = [](const Side& s) { return std::pair(s.low, s.high); };
  std::sort(sides.begin(), sides.end(),
            [&](const Side& s, const Side& t) { return key(s) != key(t) ? key(s) < key(t) : s.face < t.face; });
  Links links(model.triangles.size());
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t end = i + 1;
    while (end < sides.size() && key(sides[end]) == key(sides[i])) ++end;
    const Side &s = sides[i], &t = sides[end - 1];
    if (end - i == 2 && s.face != t.face) {
      const bool differs = s.forward == t.forward;
      links[s.face][s.corner] = {t.face, differs};
      links[t.face][t.corner] = {s.face, differs};
    } else if (end - i > 2) {
      std::size_t forward = 0;
      for (std::size_t k = i; k < end; ++k) forward += sides[k].forward;
      found.crowded_edges += 2 * forward != end - i;
    }
    i = end;
  }
  return links;
}

/// Faces that hang together, and for each whether it must be turned to look as the first one does.
struct Part {
  std::vector<std::uint32_t> faces;
  bool mixed = false, without_sides = false;
};

std::vector<Part> parts_of(const Links& links, std::vector<std::uint8_t>& turn) {
  std::vector<Part> parts;
  std::vector<std::uint8_t> seen(links.size());
  for (std::uint32_t start = 0; start < links.size(); ++start) {
    if (seen[start]) continue;
    Part part;
    part.faces.push_back(start);
    seen[start] = 1;
    for (std::size_t i = 0; i < part.faces.size(); ++i) {
      const std::uint32_t f = part.faces[i];
      for (const Link& link : links[f]) {
        if (link.face == none) continue;
        const std::uint8_t wanted = turn[f] ^ static_cast<std::uint8_t>(link.differs);
        part.mixed = part.mixed || link.differs;
        if (!seen[link.face]) {
          seen[link.face] = 1;
          turn[link.face] = wanted;
          part.faces.push_back(link.face);
        } else {
          part.without_sides = part.without_sides || turn[link.face] != wanted;
        }
      }
    }
    parts.push_back(std::move(part));
  }
  return parts;
}

Box3d bounds_of(const Model& model, const Part& part) {
  Box3d box;
  for (const std::uint32_t f : part.faces)
    for (const std::uint32_t v : model.triangles[f]) box.add(model.vertices[v]);
  return box;
}

/// True if all parts must be turned once more, besides those that differ from the first.
bool turn_all(const Model& model, const Part& part, const std::vector<std::uint8_t>& turn, const Box3d& box,
              bool enclosed) {
  double six_volumes = 0, kept = 0;  // kept: twice the area that stays as it is, less that which is turned
  for (const std::uint32_t f : part.faces) {
    const auto& [a, b, c] = model.triangles[f];
    const Vec3d p = model.vertices[a] - box.center(), q = model.vertices[b] - box.center(),
                r = model.vertices[c] - box.center();
    const double sign = turn[f] ? -1 : 1;
    six_volumes += sign * dot(p, cross(q, r));
    kept += sign * length(cross(q - p, r - p));
  }
  return enclosed ? kept < 0 : six_volumes < 0;
}

bool within(const Box3d& inner, const Box3d& outer) {
  for (int a = 0; a < 3; ++a)
    if (!(inner.min[a] > outer.min[a] && inner.max[a] < outer.max[a])) return false;
  return true;
}

/// Boxes in a tree: whether one of many encloses another box takes the time of a few.
class BoxTree {
 public:
  explicit BoxTree(std::vector<Box3d> boxes) : boxes_(std::move(boxes)) { build(0, boxes_.size()); }
  bool encloses(const Box3d& inner) const { return !nodes_.empty() && encloses(inner, 0); }

 private:
  static constexpr std::size_t leaf = 8;
  struct Node {
    Box3d hull;
    std::size_t first, end;  ///< of its boxes
    std::size_t upper = 0;   ///< node of their upper half, that of the lower one follows this; 0: a leaf
  };
  void build(std::size_t first, std::size_t end) {
    if (first == end) return;
    const std::size_t own = nodes_.size();
    Box3d hull, centers;
    for (std::size_t i = first; i < end; ++i)
      hull.add(boxes_[i].min), hull.add(boxes_[i].max), centers.add(boxes_[i].center());
    nodes_.push_back({hull, first, end});
    if (end - first <= leaf) return;
    const Vec3d size = centers.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t middle = first + (end - first) / 2;
    const auto at = [&](std::size_t i) { return boxes_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(first), at(middle), at(end),
                     [&](const Box3d& a, const Box3d& b) { return a.center()[axis] < b.center()[axis]; });
    build(first, middle);
    nodes_[own].upper = nodes_.size();
    build(middle, end);
  }
  bool encloses(const Box3d& inner, std::size_t n) const {
    const Node& node = nodes_[n];
    if (!within(inner, node.hull)) return false;
    if (node.upper > 0) return encloses(inner, n + 1) || encloses(inner, node.upper);
    for (std::size_t i = node.first; i < node.end; ++i)
      if (within(inner, boxes_[i])) return true;
    return false;
  }

  std::vector<Box3d> boxes_;  ///< those of a node side by side
  std::vector<Node> nodes_;
};

}  // namespace

Alike turn_alike(Model& model) {
  Alike found;
  const Links links = link_faces(model, found);
  std::vector<std::uint8_t> turn(model.triangles.size());
  const std::vector<Part> parts = parts_of(links, turn);
  found.parts = parts.size();
  std::vector<Box3d> boxes;
  if (std::any_of(parts.begin(), parts.end(), [](const Part& p) { return p.mixed; }))
    for (const Part& p : parts) boxes.push_back(bounds_of(model, p));
  const BoxTree tree(boxes);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    found.without_sides += parts[i].without_sides;
    if (!parts[i].mixed || parts[i].without_sides) continue;
    const bool all = turn_all(model, parts[i], turn, boxes[i], tree.encloses(boxes[i]));
    for (const std::uint32_t f : parts[i].faces) {
      if ((turn[f] != 0) == all) continue;
      std::swap(model.triangles[f][1], model.triangles[f][2]);
      ++found.turned;
    }
  }
  return found;
}

void turn_alike_with_warnings(Model& model, const std::string& name) {
  const Alike found = turn_alike(model);
  model.parts = found.parts;
  if (found.turned > 0)
    model.warnings.push_back(fmt::format("{}: {} of {} faces looked the other way than those beside them; turned", name,
                                         found.turned, model.triangles.size()));
  if (found.without_sides > 0)
    model.warnings.push_back(
        fmt::format("{}: {} of its parts have only one side, as a Moebius strip has, so no face of them looks outward; "
                    "taken as they are",
                    name, found.without_sides));
  if (found.crowded_edges > 0)
    model.warnings.push_back(
        fmt::format("{}: {} edges join three faces or more that do not look alike, so what is inside there is not "
                    "certain",
                    name, found.crowded_edges));
}

}  // namespace dreampm
