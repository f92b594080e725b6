// Whether a world that was not made by steps fits together.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "dreampm/state/world.h"

namespace dreampm {

struct WorldFault {
  std::string member, why;
};

/// What a step relies on without a look, and does not find in this world; nothing if all is there.
template <class R>
std::optional<WorldFault> find_fault(const World<R>& world);

/// The same of a list of blocks: in order, each once, and near enough that their nodes can be
/// numbered.
std::optional<std::string> find_fault(const std::vector<Vec3i>& blocks);

}  // namespace dreampm
