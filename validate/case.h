// A validation case and its report. A case is one file in cases/ and one line in cases.cpp.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dreampm/base/error.h"

namespace dreampm::validate {

/// quick: all cases within 5 minutes on 2 cores; full: within 40.
enum class Level { quick, full };

struct Options {
  Level level = Level::quick;
  std::string backend{};  ///< of all runs in float; empty: cpu
  /// Names the runs in float: "cpu (float)".
  std::string in_float() const { return (backend.empty() ? "cpu" : backend) + " (float)"; }
  // Options of the case stability:
  int draws = 0;  ///< how many; 0: those of the level
  std::uint64_t seed = 1;
  int draw = -1;   ///< only this one, from 0 on; -1: all
  double cfl = 0;  ///< of all draws instead of the drawn ones, beyond what scenes may ask for too; 0: as drawn
};

/// A text that a case leaves beside its plots: the scene of a draw that failed.
struct Attachment {
  std::string name, about, text;
};

/// The set-up of a case: the matter and walls of a scene that it runs, or a choice for it, with the
/// reason.
struct SetUp {
  std::string scene;  ///< empty: a choice
  std::string text;
};

/// One number against its gate. Without a gate it is reported and not judged.
struct Metric {
  enum class Side { none, at_most, at_least };
  std::string name, unit;
  double value = 0;
  double gate = 0;
  Side side = Side::none;
  std::string diagnosis;  ///< why the gate is missed, where that is known; it stays a miss
  double known_to = 0;    ///< how far the diagnosis reaches: what is worse is a new miss

  /// NaN passes no gate.
  bool pass() const { return side == Side::none || reaches(gate); }
  /// A miss that is listed, and does not fail the run: no worse than when it was understood.
  bool known_miss() const { return !pass() && !diagnosis.empty() && reaches(known_to); }
  /// Says why the gate is missed at present, and by how much at worst.
  void known(std::string why, double worst) { diagnosis = std::move(why), known_to = worst; }

 private:
  bool reaches(double bound) const { return side == Side::at_most ? value <= bound : value >= bound; }
};

/// The same measurement of something that is wrong: the gate must catch it.
struct Control {
  std::string what, metric, unit;
  double value = 0;
  double gate = 0;
  Metric::Side side = Metric::Side::none;
  std::optional<double> beyond;  ///< what the value must pass too, where the gate's miss is not enough
  bool fails = false;
};

struct Curve {
  std::string name;  ///< empty: not in the legend
  std::vector<double> x, y;
  bool reference = false;  ///< drawn as points
  bool bound = false;      ///< a gate, or a value that is exact for all x: drawn dashed
};

/// A dashed line at `y` from `x0` to `x1`.
inline Curve level(std::string name, double x0, double x1, double y) {
  return {std::move(name), {x0, x1}, {y, y}, false, true};
}

struct Plot {
  std::string name;  ///< of the file, without its extension
  std::string title, x_axis, y_axis;
  std::vector<Curve> curves;
};

/// A trial: the settings with which a case is run, and the report that it fills.
class Trial {
 public:
  explicit Trial(const Options& options) : options_(options) {}
  const Options& options() const { return options_; }
  bool full() const { return options_.level == Level::full; }

  Metric& at_most(std::string name, double value, double gate, std::string unit = {}) {
    return add({std::move(name), std::move(unit), value, gate, Metric::Side::at_most, {}});
  }
  Metric& at_least(std::string name, double value, double gate, std::string unit = {}) {
    return add({std::move(name), std::move(unit), value, gate, Metric::Side::at_least, {}});
  }
  void report(std::string name, double value, std::string unit = {}) {
    add({std::move(name), std::move(unit), value, 0, Metric::Side::none, {}});
  }
  /// `what` is wrong; `value` is what the metric of that name became, which its gate must refuse.
  /// `beyond`: a bound farther out than the gate, which the value must pass as well, where a
  /// reference says how wrong it has to be. Throws std::logic_error if there is no metric of that
  /// name with a gate, or the bound is no farther out.
  void control(std::string what, std::string_view metric, double value, std::optional<double> beyond = {});
  /// Adds the description of the scene of that name. A case may run a scene several times with
  /// other sizes, or wrong for a control: the first counts.
  void set_up(std::string_view scene, std::string text);
  /// Adds a choice that was made for this case beside its scenes, with its reason.
  void note_choice(std::string text) { set_ups.push_back({{}, std::move(text)}); }
  void attach(Attachment a) { attachments.push_back(std::move(a)); }
  void plot(Plot p) { plots.push_back(std::move(p)); }
  void cost(std::uint64_t steps) { particle_steps += steps; }

  std::vector<Metric> metrics;
  std::vector<Control> controls;
  std::vector<SetUp> set_ups;
  std::vector<Plot> plots;
  std::vector<Attachment> attachments;
  std::uint64_t particle_steps = 0;

 private:
  Metric& add(Metric m) { return metrics.emplace_back(std::move(m)); }
  Options options_;
};

struct Case {
  std::string_view name;
  std::string_view about;   ///< one line: what is compared with what
  std::string_view source;  ///< of the reference
  bool quick = true;        ///< false: run by --full, or when asked for by name
  void (*run)(Trial&) = nullptr;
  double seconds = 1;       ///< of a CPU at its quick level, roughly: long ones begin first
  double full_seconds = 0;  ///< the same at the full level; 0: as at the quick one

  double seconds_at(Level level) const { return level == Level::full && full_seconds > 0 ? full_seconds : seconds; }
};

}  // namespace dreampm::validate
