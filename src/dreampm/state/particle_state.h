// The state of particles, out of the columns of their set.
#pragma once
#include <algorithm>
#include <cstddef>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "dreampm/physics/materials.h"
#include "dreampm/state/world.h"

namespace dreampm {

/// The state of particle `p` of a set of material M.
template <class M, class R>
typename M::template State<R> state_of(const ParticleSet<R>& set, std::size_t p) {
  typename M::template State<R> state;
  for (int c = 0; c < state_columns<M>; ++c) state[c] = set.state[static_cast<std::size_t>(c)][p];
  return state;
}

/// The number of a material's column of state of that name; nothing where it has none.
inline std::optional<std::size_t> find_column(std::string_view material, std::string_view name) {
  std::optional<std::size_t> found;
  Materials::with(material, [&]<class M>() {
    const auto& names = M::template State<float>::names;
    const auto at = std::find(std::begin(names), std::end(names), name);
    if (at != std::end(names)) found = static_cast<std::size_t>(at - std::begin(names));
  });
  return found;
}
/// The same. Throws std::out_of_range where the material has none.
inline std::size_t column_index(std::string_view material, std::string_view name) {
  const std::optional<std::size_t> found = find_column(material, name);
  if (!found) throw std::out_of_range(std::string(material) + " has no column " + std::string(name));
  return *found;
}

/// The column of that name, for edits. Throws std::out_of_range if the set's material has none, or
/// the set no matter yet.
template <class R>
LargeVector<R>& state_column(ParticleSet<R>& set, std::string_view name) {
  return set.state.at(column_index(set.material, name));
}

/// Puts all particles of a set into the state in which new matter comes.
template <class R>
void put_to_rest(ParticleSet<R>& set) {
  Materials::with(set.material, [&]<class M>() {
    for (std::size_t c = 0; c < set.state.size(); ++c)
      std::fill(set.state[c].begin(), set.state[c].end(), static_cast<R>(M::template State<R>::rest[c]));
  });
}

}  // namespace dreampm
