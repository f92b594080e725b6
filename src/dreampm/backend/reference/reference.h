// The oracle: scalar loops in the order of the paper, in float or double. Slow on purpose, read it beside docs and
// tests.
#pragma once
#include <memory>

#include "dreampm/backend/backend.h"

namespace dreampm {

template <class R>
std::unique_ptr<Backend<R>> make_reference_backend();

}  // namespace dreampm
