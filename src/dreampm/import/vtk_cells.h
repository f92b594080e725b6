// Cells as files of VTK have them.
#pragma once
#include <string>
#include <vector>

#include "dreampm/geometry/model.h"

namespace dreampm {

/// Cells of one kind. Cell i names the points connectivity[offsets[i]] to [offsets[i + 1] - 1].
struct VtkCells {
  std::string kind;  ///< vertices, lines, polygons, triangle_strips, or cells, whose types say it
  std::vector<double> connectivity, offsets;
  std::vector<double> types;  ///< of `cells`, one each
};

/// Adds polygons, strips, triangles and quads to the model's faces; passes over the others, with a
/// warning for cells that enclose a volume. Throws InputError naming `file` where they name what is
/// not there.
void add_vtk_cells(Model& model, const std::vector<VtkCells>& cells, const std::string& file);

}  // namespace dreampm
