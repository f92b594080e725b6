// How messages name a place in a scene file.
#pragma once
#include <fmt/format.h>

#include <string>

#include "dreampm/scene/mark.h"

namespace dreampm {

/// file:line:column; the file alone where the scene was made in memory.
inline std::string place(const std::string& file, const scene::Mark& mark) {
  return mark.line > 0 ? fmt::format("{}:{}:{}", file, mark.line, mark.column) : file;
}

}  // namespace dreampm
