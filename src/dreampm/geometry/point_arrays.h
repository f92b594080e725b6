// What a file says of its points beside their places, by the names that programs give it.
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

/// Takes velocities (velocity, velocities, vel, v, u: three columns), ids (id, ids, globalids,
/// particleid, particle_id) and colors (color, colors, rgb, rgba, cd: three or four columns), in
/// upper or lower case; others are passed over. Throws InputError naming `file` where there is not
/// one row a point, and for a velocity that is not finite.
void take_point_array(Model& model, const PointArray& array, const std::string& file);

}  // namespace dreampm
