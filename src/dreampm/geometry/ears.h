// Polygons in a plane, cut into triangles.
#pragma once
#include <array>
#include <cstddef>
#include <vector>

namespace dreampm {

/// The triangles of a polygon that turns to the left as a whole: corners by their numbers, n - 2
/// times three. One without inward corners becomes a fan; others are cut at their ears, that of the
/// lowest number first. Takes the time of n times the inward corners that an ear spans.
std::vector<std::array<std::size_t, 3>> cut_polygon(const std::vector<std::array<double, 2>>& corners);

}  // namespace dreampm
