// The table of a material's parameters: one declaration feeds the parser, its messages, the docs
// and the sliders.
#pragma once
#include <cmath>
#include <limits>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace dreampm {

/// A word that may stand for a number in a scene: `linear`, `true`.
struct Word {
  std::string_view name;
  double value;
};

inline constexpr double derived = std::numeric_limits<double>::quiet_NaN();  ///< a default that the solver works out

/// One parameter. `value` is the default (`derived`: none); min and max are inclusive.
struct Param {
  std::string_view key, unit;
  double value, min, max;
  bool log = false;  ///< a slider moves in decades
  std::string_view help;
  std::span<const Word> words = {};  ///< words accepted instead of a number; if `words_only`, nothing else is
  bool words_only = false;
  std::string_view excludes = {};  ///< a key that must not be given together with this one
};

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

/// What a user may know about a material without its law.
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

/// Parameter values by key, complete once `with_defaults` was called. NaN: derive it.
class Values {
 public:
  void set(std::string_view key, double v) { values_.insert_or_assign(std::string(key), v); }
  bool has(std::string_view key) const {
    auto it = values_.find(key);
    return it != values_.end() && !std::isnan(it->second);
  }
  /// Throws std::out_of_range for a key that is not there.
  double operator[](std::string_view key) const {
    const auto it = values_.find(key);  // at() would make a string of it
    if (it == values_.end()) throw std::out_of_range("no value of " + std::string(key));
    return it->second;
  }
  void with_defaults(std::span<const Param> params) {
    for (const Param& p : params) values_.try_emplace(std::string(p.key), p.value);
  }
  auto begin() const { return values_.begin(); }
  auto end() const { return values_.end(); }

 private:
  std::map<std::string, double, std::less<>> values_;
};

/// What a set of values comes to, for matter at rest.
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

}  // namespace dreampm
