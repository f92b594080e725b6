#include "dreampm/import/vtk_cells.h"

#include "dreampm/base/error.h"
#include "dreampm/geometry/whole.h"

namespace dreampm {
namespace {

/// The role of a cell in a mesh, by VTK's number of its type.
enum class Role { none, polygon, strip, solid };
Role role_of(double type) {
  if (type == 5 || type == 7 || type == 9) return Role::polygon;
  if (type == 6) return Role::strip;
  return type >= 10 ? Role::solid : Role::none;
}
Role role_of(const std::string& kind) {
  return kind == "polygons" ? Role::polygon : kind == "triangle_strips" ? Role::strip : Role::none;
}

/// A number from 0 to `most`.
std::size_t index(double value, std::size_t most, const char* what, const std::string& file) {
  const std::optional<std::size_t> n = whole<std::size_t>(value);
  if (!n || *n > most) fail_input("{}: its cells name {} {}; 0 to {} are there", file, what, value, most);
  return *n;
}

}  // namespace

void add_vtk_cells(Model& model, const std::vector<VtkCells>& all, const std::string& file) {
  std::size_t solids = 0;
  for (const VtkCells& cells : all) {
    const std::size_t count = cells.offsets.empty() ? 0 : cells.offsets.size() - 1;
    const bool mixed = cells.kind == "cells";
    if (mixed && cells.types.size() != count)
      fail_input("{}: has {} cells, but {} types of cells", file, count, cells.types.size());
    for (std::size_t c = 0; c < count; ++c) {
      const Role role = mixed ? role_of(cells.types[c]) : role_of(cells.kind);
      solids += role == Role::solid;
      if (role != Role::polygon && role != Role::strip) continue;
      const std::size_t first = index(cells.offsets[c], cells.connectivity.size(), "the place", file);
      const std::size_t end = index(cells.offsets[c + 1], cells.connectivity.size(), "the place", file);
      // Else a few cells, forth and back, would name all points each.
      if (end < first) fail_input("{}: cell {} begins at the place {} and ends at {}", file, c, first, end);
      std::vector<std::uint32_t> corners;
      for (std::size_t k = first; k < end; ++k)
        corners.push_back(
            static_cast<std::uint32_t>(index(cells.connectivity[k], model.vertices.size() - 1, "the point", file)));
      if (role == Role::polygon)
        add_polygon(model, corners);
      else
        add_strip(model, corners);
    }
  }
  if (solids > 0)
    model.warnings.push_back(
        fmt::format("{}: {} of its cells enclose volumes; only their points are read", file, solids));
}

}  // namespace dreampm
