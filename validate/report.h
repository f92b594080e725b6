// Runs cases and reports how they went.
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "validate/case.h"
#include "validate/cases.h"

namespace dreampm::validate {

struct Result {
  const Case* which = nullptr;
  Options options;
  std::vector<Metric> metrics;
  std::vector<Control> controls;
  std::vector<SetUp> set_ups;
  std::vector<std::filesystem::path> plots;
  std::vector<Attachment> attachments;  ///< their names with the folder
  std::uint64_t particle_steps = 0;
  double seconds = 0;      ///< by the clock
  double cpu_seconds = 0;  ///< of all threads
  std::string error;       ///< why the run itself ended early; empty if it did not

  /// Every gate held and has a control, and every control was caught.
  bool passed() const;
  /// It did not pass, and all that is wrong are misses that are known.
  bool known() const;
  /// True if a control was run against the gate of that metric; also without a gate.
  bool controlled(const Metric& metric) const;

 private:
  /// It ran to its end, and its gates can refuse.
  bool sound() const;
};

/// The scope of CPU seconds.
enum class Clock { process, thread };

/// Runs one case; plots and attachments go into `folder`. An error of the case is its result, not
/// thrown; Interrupted is thrown.
Result run_case(const Case& which, const Options& options, const std::filesystem::path& folder,
                Clock clock = Clock::process);

/// The cases of a level, in the list's order.
std::vector<const Case*> cases_of(Level level);

/// Lines for a terminal: one a metric and control, then the cost.
std::string text_of(const Result& result);
/// "11 of 12 cases passed, 1 missed gates as it is known to, 0 failed" with every missed gate by
/// name. `seconds`: of the whole run by the clock.
std::string summary_of(const std::vector<Result>& results, double seconds);
/// True if nothing failed, apart from misses that are known.
bool succeeded(const std::vector<Result>& results);
/// FORMATS: {"cases": [{"name", "set_up", "metrics": ..}], "passed", "failed"}, passed and failed
/// counting cases; "known" counts those of the failed that only miss what they are known to miss.
std::string json_of(const std::vector<Result>& results);
/// The text before the result of a case, in its section of the page.
inline constexpr std::string_view result_mark = "Result: ";
/// The section of a case in the page docs/validation.md (page.h), `plots` being the folder of the
/// pictures as the page sees it.
std::string section_of(const Result& result, const std::string& plots);

}  // namespace dreampm::validate
