// Checks of a world that was not made by steps.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "dreampm/state/world.h"

namespace dreampm {

struct WorldFault {
  std::string member, why;
};

/// Returns the first condition that steps rely on unchecked and that this world does not meet;
/// nothing if it meets all.
template <class R>
std::optional<WorldFault> find_fault(const World<R>& world);

/// The same of a list of blocks: in order, each once, and near enough that their nodes can be
/// numbered.
std::optional<std::string> find_fault(const std::vector<Vec3i>& blocks);

}  // namespace dreampm
