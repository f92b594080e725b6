// The limits of the projection: scenes that it refuses.
#pragma once
#include <string>
#include <vector>

#include "dreampm/model/scene.h"

namespace dreampm {

/// A line for each part of a scene with `time.solver: projection` that this solver cannot do, with
/// its place in `file` and what would be right. None for other scenes.
std::vector<std::string> projection_refusals(const model::Scene& scene, const std::string& file);

/// A line where its steps are longer than a final run should have; else empty.
std::string projection_warning(const model::Scene& scene, const std::string& file);

}  // namespace dreampm
