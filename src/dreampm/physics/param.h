// The table of a material's parameters: one declaration feeds the parser, its messages, the docs
// and the sliders.
#pragma once
#include <cmath>
#include <limits>
#include <span>
#include <string_view>

#include "dreampm/model/matter.h"

namespace dreampm {

/// A word that may stand for a number in a scene: `linear`, `true`.
struct Word {
  std::string_view name;
  double value;
};

inline constexpr double derived = std::numeric_limits<double>::quiet_NaN();  ///< a default that the solver works out

/// How a parameter is shown where it is set by hand, as by a slider of the playground.
struct Slider {
  /// What it covers; `derived`: the range of the parameter, of a slider in decades some of them.
  double min = derived, max = derived;
  std::string_view label = {};  ///< empty: the key, with blanks
  bool basic = false;           ///< whether beginners see it; in a table without such rows they see all
  /// A switch of the same table that must be on, or off, for the parameter to have an effect;
  /// empty: none.
  std::string_view needs_on = {}, needs_off = {};
};

/// One parameter. `value` is the default (`derived`: none); min and max are inclusive.
struct Param {
  std::string_view key, unit;
  double value, min, max;
  bool log = false;  ///< a slider moves in decades
  std::string_view help;
  std::span<const Word> words = {};  ///< words accepted instead of a number; if `words_only`, nothing else is
  bool words_only = false;
  std::string_view excludes = {};  ///< a key that must not be given together with this one
  Slider slider = {};

  /// The same parameter with that slider.
  constexpr Param shown(const Slider& by) const {
    Param own = *this;
    own.slider = by;
    return own;
  }
};

/// Whether sliders of a table cover values that the parameters may have, and need switches that the
/// table has.
constexpr bool has_right_sliders(std::span<const Param> table) {
  const auto is_switch = [&](std::string_view key) {
    for (const Param& p : table)
      if (p.key == key) return p.words_only;
    return key.empty();
  };
  for (const Param& p : table) {
    const Slider& s = p.slider;
    if (s.min < p.min || s.max > p.max || s.min >= s.max) return false;  // false for what is derived
    if (!is_switch(s.needs_on) || !is_switch(s.needs_off)) return false;
  }
  return true;
}

inline constexpr Word flag_words[] = {{"false", 0}, {"true", 1}};

/// A named set of values with the source they were taken from.
struct Preset {
  struct Value {
    std::string_view key;
    double value;
  };
  std::string_view name, source;
  std::span<const Value> values;
};

/// The public description of a material, without its law.
struct MaterialInfo {
  std::string_view name, help;
  std::span<const Param> params;
  std::span<const Preset> presets;
  bool liquid;

  const Param* find(std::string_view key) const {
    for (const Param& p : params)
      if (p.key == key) return &p;
    return nullptr;
  }
};

/// Derived values of a set of parameters, for matter at rest.
struct MaterialFacts {
  double sound_speed;          ///< m/s
  double kinematic_viscosity;  ///< what bounds the step [m^2/s]; 0 where the law solves its viscosity implicitly
  double poissons_ratio;       ///< of small elastic strains; 1/2 where only volume resists
};
/// `values`: complete, with nothing left to derive. Works for every material of the list; throws
/// std::out_of_range for a name that is not in it.
MaterialFacts facts_of(const MaterialInfo& info, const Values& values);

/// Every material of the build, in the order of the one list (physics/materials.h).
std::span<const MaterialInfo> material_infos();
/// The material of that name, or null.
const MaterialInfo* find_material(std::string_view name);
/// Returns the description of a checked scene's material. Throws std::out_of_range for a type that
/// is not in the list.
const MaterialInfo& info_of(const model::Material& material);

}  // namespace dreampm
