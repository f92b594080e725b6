#include "dreampm/pictures/absorption_of.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

#include "dreampm/math/look_color.h"
#include "dreampm/math/pigments.h"

namespace dreampm {
namespace {

/// In spacings: cells hold some 64 particles, and colors change over no less.
constexpr float cell_size = 2;
/// Cells round the particles, which the surface may reach.
constexpr int margin = 2;
/// Nothing absorbs more than what lets through so much of the layer.
constexpr double least_color = 1e-3;

/// Cells that hold nothing get the mean of those beside them that do, in rounds.
void fill_round(AbsorptionField& field, std::vector<std::uint8_t>& known, int rounds) {
  const auto& n = field.size;
  for (int round = 0; round < rounds; ++round) {
    const std::vector<std::uint8_t> before = known;
    for (int z = 0; z < n[2]; ++z)
      for (int y = 0; y < n[1]; ++y)
        for (int x = 0; x < n[0]; ++x) {
          const std::size_t i = field.index(x, y, z);
          if (before[i] != 0) continue;
          Vec3f sum;
          float count = 0;
          const auto beside = [&](int xx, int yy, int zz) {
            if (xx < 0 || yy < 0 || zz < 0 || xx >= n[0] || yy >= n[1] || zz >= n[2]) return;
            if (const std::size_t j = field.index(xx, yy, zz); before[j] != 0) sum += field.values[j], ++count;
          };
          beside(x - 1, y, z), beside(x + 1, y, z), beside(x, y - 1, z);
          beside(x, y + 1, z), beside(x, y, z - 1), beside(x, y, z + 1);
          if (count > 0) field.values[i] = sum / count, known[i] = 1;
        }
  }
}

}  // namespace

Vec3d absorption_of(const Vec3f& color) {
  const auto channel = [](float c) {
    return -std::log(std::clamp(static_cast<double>(c), least_color, 1.0)) / shown_layer;
  };
  return {channel(color.x), channel(color.y), channel(color.z)};
}

AbsorptionField absorption_field(std::span<const Vec3f> positions, std::span<const Vec3f> colors, float spacing) {
  AbsorptionField field;
  field.cell = cell_size * spacing;
  Box3f box;
  for (const Vec3f& p : positions) box.add(p);
  field.corner = box.min - Vec3f{1, 1, 1} * (margin * field.cell);
  for (int a = 0; a < 3; ++a)
    field.size[static_cast<std::size_t>(a)] = static_cast<int>(box.size()[a] / field.cell) + 1 + 2 * margin;
  const std::size_t cells = field.index(0, 0, field.size[2]);
  field.values.assign(cells, {});
  std::vector<std::uint8_t> known(cells);
  // Colors are few: each becomes a pigment once.
  std::map<std::tuple<float, float, float>, Pigment> pigments;
  std::vector<std::optional<PigmentMix>> mixes(cells);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Vec3f u = (positions[i] - field.corner) / field.cell;
    std::optional<PigmentMix>& mix =
        mixes[field.index(static_cast<int>(u.x), static_cast<int>(u.y), static_cast<int>(u.z))];
    if (!mix) mix.emplace(Mixing::clear);
    const Vec3f& c = colors[i];
    const auto [at, is_new] = pigments.try_emplace({c.x, c.y, c.z});
    if (is_new) at->second = Pigment::of(c, Mixing::clear);
    mix->add(at->second, 1);
  }
  for (std::size_t i = 0; i < cells; ++i)
    if (mixes[i]) field.values[i] = static_cast<Vec3f>(absorption_of(mixes[i]->color())), known[i] = 1;
  fill_round(field, known, 2 * margin);
  return field;
}

}  // namespace dreampm
