#include "dreampm/import/point_arrays.h"

#include <algorithm>

#include "dreampm/base/error.h"
#include "dreampm/geometry/whole.h"
#include "dreampm/import/text_lines.h"

namespace dreampm {
namespace {

using Take = void (*)(Model&, const PointArray&, const std::string& file);

/// The meaning of an array.
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

void take_ids(Model& model, const PointArray& array, const std::string& file) {
  model.ids.clear();
  for (const double v : array.values) {
    const std::optional<std::int64_t> id = whole<std::int64_t>(v);
    if (!id) fail_input("{}: the id of point {} is {}: a whole number is wanted", file, model.ids.size(), v);
    model.ids.push_back(*id);
  }
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

/// Null for an array that is passed over.
const Meaning* meaning_of(const std::string& name, std::size_t columns) {
  for (const Meaning& m : meanings())
    if (columns >= m.least && columns <= m.most &&
        std::find(m.names.begin(), m.names.end(), lower(name)) != m.names.end())
      return &m;
  return nullptr;
}

}  // namespace

bool is_point_array(const std::string& name, std::size_t columns) { return meaning_of(name, columns) != nullptr; }

void take_point_array(Model& model, const PointArray& array, const std::string& file) {
  const Meaning* const meaning = meaning_of(array.name, array.columns);
  if (!meaning) return;
  if (array.values.size() != model.vertices.size() * array.columns)
    fail_input("{}: its array {} has {} values for {} points of {} each", file, array.name, array.values.size(),
               model.vertices.size(), array.columns);
  meaning->take(model, array, file);
}

}  // namespace dreampm
