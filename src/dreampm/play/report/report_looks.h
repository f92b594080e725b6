// What the report's slider shows: each of its looks by name, with all that it takes.
#pragma once
#include <array>
#include <span>
#include <string_view>

namespace dreampm::play {

/// Values of the parameters of the material `seed`.
struct ReportLook {
  std::string_view name, title, help;
  double v, lower, upper;
  bool elastic;

  struct Value {
    std::string_view key;
    double value;
  };
  /// What is set, by the keys of the parameters.
  std::array<Value, 4> values() const {
    return {{{"v", v}, {"lower", lower}, {"upper", upper}, {"elastic", elastic ? 1.0 : 0.0}}};
  }
};
/// Liquid, honey, stone and elastic, in this order.
std::span<const ReportLook> report_looks();
/// Throws InputError for a name that no look has.
const ReportLook& report_look(std::string_view name);

}  // namespace dreampm::play
