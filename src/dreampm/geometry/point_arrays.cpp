#include "dreampm/geometry/point_arrays.h"

#include <algorithm>

#include "dreampm/base/error.h"
#include "dreampm/geometry/text_lines.h"

namespace dreampm {
namespace {

using Take = void (*)(Model&, const PointArray&, const std::string& file);

/// What an array can be.
struct Meaning {
  std::vector<std::string> names;
  std::size_t least, most;  ///< columns
  Take take;
};

void take_velocities(Model& model, const PointArray& array, const std::string& file) {
  model.velocities.resize(model.vertices.size());
  for (std::size_t i = 0; i < model.vertices.size(); ++i) {
    const double* const v = &array.values[3 * i];
    model.velocities[i] = {v[0], v[1], v[2]};
    if (!is_finite(model.velocities[i])) fail_input("{}: the velocity of point {} is not finite", file, i);
  }
}

void take_ids(Model& model, const PointArray& array, const std::string&) {
  model.ids.clear();
  for (const double v : array.values) model.ids.push_back(static_cast<std::int64_t>(v));
}

void take_colors(Model& model, const PointArray& array, const std::string&) {
  model.colors.assign(model.vertices.size(), {0, 0, 0, 255});
  for (std::size_t i = 0; i < model.vertices.size(); ++i)
    for (std::size_t c = 0; c < array.columns; ++c)
      model.colors[i][c] = color_byte(array.values[array.columns * i + c] * (array.bytes ? 1 : 255));
}

const std::vector<Meaning>& meanings() {
  static const std::vector<Meaning> all{{{"velocity", "velocities", "vel", "v", "u"}, 3, 3, take_velocities},
                                        {{"id", "ids", "globalids", "particleid", "particle_id"}, 1, 1, take_ids},
                                        {{"color", "colors", "rgb", "rgba", "cd"}, 3, 4, take_colors}};
  return all;
}

}  // namespace

void take_point_array(Model& model, const PointArray& array, const std::string& file) {
  const std::string name = lower(array.name);
  for (const Meaning& m : meanings()) {
    if (std::find(m.names.begin(), m.names.end(), name) == m.names.end()) continue;
    if (array.columns < m.least || array.columns > m.most) continue;
    if (array.values.size() != model.vertices.size() * array.columns)
      fail_input("{}: its array {} has {} values for {} points of {} each", file, array.name, array.values.size(),
                 model.vertices.size(), array.columns);
    m.take(model, array, file);
  }
}

}  // namespace dreampm
