// Arrays of a file's points beside their positions, by the names that programs give them.
#pragma once
#include <string>
#include <vector>

#include "dreampm/geometry/model.h"

namespace dreampm {

/// Values for each point, row by row.
struct PointArray {
  std::string name;
  std::size_t columns = 1;
  std::vector<double> values;
  bool bytes = false;  ///< of colors: 0 to 255, else 0 to 1
};

/// True if an array is velocities (velocity, velocities, vel, v, u: three columns), ids (id, ids,
/// globalids, particleid, particle_id) or colors (color, colors, rgb, rgba, cd: three or four
/// columns), in upper or lower case. To be asked before the values of others are read, which may be
/// no numbers.
bool is_point_array(const std::string& name, std::size_t columns);

/// Takes such an array; others are passed over. Throws InputError naming `file` where there is not
/// one row a point, for a velocity that is not finite, and for an id that is no whole number.
void take_point_array(Model& model, const PointArray& array, const std::string& file);

}  // namespace dreampm
