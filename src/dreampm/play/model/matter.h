// The kinds of matter that can be poured and dropped.
#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

#include "dreampm/play/model/action.h"
#include "dreampm/vec.h"

namespace dreampm::play {

struct Matter {
  std::string_view name;  ///< of the material in a scene
  std::string_view title;
  std::string_view scene;   ///< what stands behind its name in the `materials` of a scene file
  std::string_view look;    ///< what stands behind its name in `render.looks`
  char key;                 ///< on the keyboard
  std::string_view beside;  ///< the matter that it is compared with
};

/// Ten, in the order of their keys.
std::span<const Matter> matters();
/// The kind, an index into matters(), that a material of a scene is of: by its name, or else by the
/// name of its type; `viscosity` [Pa s]: of a liquid.
std::optional<std::size_t> kind_of(std::string_view name, std::string_view type, double viscosity);
/// The kind that one is compared with.
std::size_t compared_with(std::size_t kind);

/// What compares with the choice of the control `compare_with`.
Action compare_with(std::size_t choice);

}  // namespace dreampm::play
