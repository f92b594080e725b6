// Several cases side by side.
#pragma once
#include <functional>
#include <span>
#include <vector>

#include "validate/report.h"

namespace dreampm::validate {

/// Throws InputError where this machine cannot run the options' backend, or it computes in double.
void check_backend(const Options& options);

/// Runs the cases, as many at once as there are threads, each on one; a case alone has all of them.
/// Results do not depend on it. Those that take longest begin first; done() is called in the order
/// of `cases`, one at a time, from any thread. Returns the results in that order; those of cases
/// that were not done when a signal came are left out. What run_case throws, Interrupted apart, is
/// thrown after the others ended.
std::vector<Result> run_cases(std::span<const Case* const> cases, const Options& options,
                              const std::filesystem::path& folder, const std::function<void(const Result&)>& done);

}  // namespace dreampm::validate
