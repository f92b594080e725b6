// What a validation case is, and what it reports. A case is one file in cases/ and one line in cases.cpp.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dreampm/base/error.h"

namespace dreampm::validate {

/// quick: all cases within 3 minutes on 2 cores; full: within 40.
enum class Level { quick, full };

/// One number against its gate. Without a gate it is told and not judged.
struct Metric {
  enum class Side { none, at_most, at_least };
  std::string name, unit;
  double value = 0;
  double gate = 0;
  Side side = Side::none;
  std::string diagnosis;  ///< of a miss that is understood; it stays a miss

  /// NaN passes no gate.
  bool pass() const { return side == Side::none || (side == Side::at_most ? value <= gate : value >= gate); }
};

/// The same measurement of something that is wrong: the gate must catch it.
struct Control {
  std::string what, metric, unit;
  double value = 0;
  double gate = 0;
  bool fails = false;
};

struct Curve {
  std::string name;
  std::vector<double> x, y;
  bool reference = false;  ///< drawn as points
};

struct Plot {
  std::string name;  ///< of the file, without its extension
  std::string title, x_axis, y_axis;
  std::vector<Curve> curves;
};

/// What a case is run with and what it reports into.
class Trial {
 public:
  explicit Trial(Level level) : level_(level) {}
  Level level() const { return level_; }
  bool full() const { return level_ == Level::full; }

  Metric& at_most(std::string name, double value, double gate, std::string unit = {}) {
    return add({std::move(name), std::move(unit), value, gate, Metric::Side::at_most, {}});
  }
  Metric& at_least(std::string name, double value, double gate, std::string unit = {}) {
    return add({std::move(name), std::move(unit), value, gate, Metric::Side::at_least, {}});
  }
  void tell(std::string name, double value, std::string unit = {}) {
    add({std::move(name), std::move(unit), value, 0, Metric::Side::none, {}});
  }
  /// `what` is wrong; `value` is what the metric of that name became, which its gate must refuse. Throws
  /// std::logic_error if there is no metric of that name with a gate.
  void control(std::string what, std::string_view metric, double value);
  void plot(Plot p) { plots.push_back(std::move(p)); }
  void cost(std::uint64_t steps) { particle_steps += steps; }

  std::vector<Metric> metrics;
  std::vector<Control> controls;
  std::vector<Plot> plots;
  std::uint64_t particle_steps = 0;

 private:
  Metric& add(Metric m) { return metrics.emplace_back(std::move(m)); }
  Level level_;
};

struct Case {
  std::string_view name;
  std::string_view about;   ///< one line: what is compared with what
  std::string_view source;  ///< of the reference
  bool quick = true;        ///< false: run by --full, or when asked for by name
  void (*run)(Trial&) = nullptr;
};

}  // namespace dreampm::validate
