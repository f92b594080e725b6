// Materials, and the bodies of matter that there are at the start.
#pragma once
#include <cmath>
#include <functional>
#include <initializer_list>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "dreampm/shape.h"
#include "dreampm/vec.h"

namespace dreampm {

/// Numbers by key, as the parameters of a material. NaN: the solver works it out. Complete once
/// `with_defaults` was called.
class Values {
 public:
  Values() = default;
  Values(std::initializer_list<std::pair<const std::string, double>> values) : values_(values) {}

  void set(std::string_view key, double v) { values_.insert_or_assign(std::string(key), v); }
  /// Adds the default of each of `params` that has no value.
  template <class Params>
  void with_defaults(const Params& params) {
    for (const auto& p : params) values_.try_emplace(std::string(p.key), p.value);
  }
  void erase(std::string_view key) {
    if (const auto it = values_.find(key); it != values_.end()) values_.erase(it);
  }
  /// True if the key has a value, and that is a number.
  bool has(std::string_view key) const {
    const auto it = values_.find(key);
    return it != values_.end() && !std::isnan(it->second);
  }
  /// Throws std::out_of_range for a key that is not there.
  double operator[](std::string_view key) const {
    const auto it = values_.find(key);  // at() would make a string of it
    if (it == values_.end()) throw std::out_of_range("no value of " + std::string(key));
    return it->second;
  }
  auto begin() const { return values_.begin(); }
  auto end() const { return values_.end(); }
  bool empty() const { return values_.empty(); }

 private:
  std::map<std::string, double, std::less<>> values_;
};

/// The pattern in which particles fill a body.
enum class Pattern {
  jitter,   ///< the centers of cubic cells, each moved by up to a quarter of the spacing along every axis
  lattice,  ///< the centers of cubic cells
  poisson   ///< random points that keep 0.89 spacings apart and leave no room for another
};

namespace model {

/// A material: a type of `dreampm materials` with values of its parameters. Words such as false and
/// true are numbers too; `dreampm materials TYPE` lists them.
struct Material {
  std::string name;                ///< as bodies and emitters call it
  std::string type = "newtonian";  ///< newtonian, elastic, snow, ...
  /// The values by key. Keys that are not there have their defaults.
  Values values{};
  std::string transfer = "apic";  ///< between its particles and the grid: apic, flip or asflip
  Values transfer_values{};       ///< flip_blend, flip_memory, ...: what the transfer takes
};

/// Matter that is there at the start.
struct Body {
  std::string name;
  std::string material;  ///< the name of one
  Shape shape{};
  Vec3d velocity{};              ///< m/s
  Vec3d spin{};                  ///< rad/s about the body's center
  std::optional<Vec3d> color{};  ///< sRGB, 0 to 1; absent: the look of its material
  Pattern pattern = Pattern::jitter;
  std::vector<std::string> cut{};  ///< names of colliders and rigid bodies: it has no matter inside of them
};

}  // namespace model
}  // namespace dreampm
