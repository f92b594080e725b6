// Runs cases and tells how they went.
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "dreampm/validate/case.h"
#include "dreampm/validate/cases.h"

namespace dreampm::validate {

struct Result {
  const Case* which = nullptr;
  Level level = Level::quick;
  std::vector<Metric> metrics;
  std::vector<Control> controls;
  std::vector<std::filesystem::path> plots;
  std::uint64_t particle_steps = 0;
  double seconds = 0;      ///< by the clock
  double cpu_seconds = 0;  ///< of all threads
  std::string error;       ///< why the run itself ended early; empty if it did not

  /// Every gate held and every control was caught.
  bool passed() const;
};

/// Runs one case; plots go into `folder`. A RunError of the case is its result, not thrown; Interrupted is thrown.
Result run_case(const Case& which, Level level, const std::filesystem::path& folder);

/// The cases of a level, in the list's order.
std::vector<const Case*> cases_of(Level level);

/// Lines for a terminal: one a metric and control, then the cost.
std::string text_of(const Result& result);
/// "11 of 12 cases passed, ..." with every missed gate by name.
std::string summary_of(const std::vector<Result>& results);
/// FORMATS: {"cases": [{"name", "metrics": ..}], "passed", "failed"}, passed and failed counting cases.
std::string json_of(const std::vector<Result>& results);
/// The page docs/validation.md, `plots` being the folder of the pictures as the page sees it.
std::string markdown_of(const std::vector<Result>& results, const std::string& plots);

}  // namespace dreampm::validate
