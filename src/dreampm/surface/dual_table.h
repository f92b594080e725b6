// The table of dual marching cubes: which crossed edges of a cell belong to one sheet of the
// surface.
#pragma once
#include <array>
#include <cstdint>

namespace dreampm::surface {

/// Corner c of a cell: bit 0 is x, bit 1 y, bit 2 z. Edge 4 a + u + 2 v runs along axis a; u and v
/// are its offsets along axes a + 1 and a + 2 (mod 3). Face 2 a + s is normal to axis a, on side s.
struct DualTable {
  struct Entry {
    std::array<std::int8_t, 12> patch{};  ///< sheet of each edge, -1 if it is not crossed
    std::uint8_t patches = 0;
    std::uint8_t joined = 0;  ///< bit f: face f is ambiguous and all four of its edges belong to one sheet
  };
  std::array<Entry, 256> entries{};  ///< by the set of inside corners
  constexpr const Entry& operator[](std::uint8_t corners) const { return entries[corners]; }
};

constexpr int edge_base(int edge) {
  const int a = edge / 4, b = (a + 1) % 3, c = (a + 2) % 3;
  return (edge & 1) << b | (edge >> 1 & 1) << c;
}
constexpr int edge_axis(int edge) { return edge / 4; }

/// Makes the table. On a face whose inside corners are diagonal the inside corners are joined: each
/// outside corner is cut off alone. Both cells at the face see it alike, so sheets meet without
/// gaps.
constexpr DualTable make_dual_table() {
  DualTable table;
  for (int config = 0; config < 256; ++config) {
    auto& e = table.entries[static_cast<std::size_t>(config)];
    const auto inside = [&](int corner) { return (config >> corner & 1) != 0; };
    std::array<int, 12> root{};
    std::array<bool, 12> crossed{};
    for (int k = 0; k < 12; ++k) {
      root[static_cast<std::size_t>(k)] = k;
      crossed[static_cast<std::size_t>(k)] = inside(edge_base(k)) != inside(edge_base(k) | 1 << edge_axis(k));
    }
    const auto join = [&](int p, int q) {
      const int from = root[static_cast<std::size_t>(p)], to = root[static_cast<std::size_t>(q)];
      for (int& r : root)
        if (r == from) r = to;
    };
    std::array<bool, 6> ambiguous{};
    std::array<std::array<int, 4>, 6> face_edge{};  // around the face: from corner i to corner i + 1
    for (int f = 0; f < 6; ++f) {
      const int a = f / 2, b = (a + 1) % 3, c = (a + 2) % 3, side = f % 2;
      auto& edges = face_edge[static_cast<std::size_t>(f)];
      // Edges along b: offsets (c, a); along c: offsets (a, b).
      edges = {4 * b + 2 * side, 4 * c + side + 2, 4 * b + 1 + 2 * side, 4 * c + side};
      const std::array<int, 4> corner{side << a, side << a | 1 << b, side << a | 1 << b | 1 << c, side << a | 1 << c};
      int count = 0, firsts[4] = {};
      for (int k : edges)
        if (crossed[static_cast<std::size_t>(k)]) firsts[count++] = k;
      if (count == 2) join(firsts[0], firsts[1]);
      if (count == 4) {
        ambiguous[static_cast<std::size_t>(f)] = true;
        for (std::size_t i = 0; i < 4; ++i)
          if (!inside(corner[i])) join(edges[i], edges[(i + 3) % 4]);
      }
    }
    std::array<int, 12> number{};
    number.fill(-1);
    for (std::size_t k = 0; k < 12; ++k) {
      e.patch[k] = -1;
      if (!crossed[k]) continue;
      auto& n = number[static_cast<std::size_t>(root[k])];
      if (n < 0) n = e.patches++;
      e.patch[k] = static_cast<std::int8_t>(n);
    }
    for (std::size_t f = 0; f < 6; ++f) {
      if (!ambiguous[f]) continue;
      const int p = e.patch[static_cast<std::size_t>(face_edge[f][0])];
      bool one = true;
      for (int k : face_edge[f]) one = one && e.patch[static_cast<std::size_t>(k)] == p;
      if (one) e.joined = static_cast<std::uint8_t>(e.joined | 1u << f);
    }
  }
  return table;
}

}  // namespace dreampm::surface
