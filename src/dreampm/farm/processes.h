// Some programs at a time.
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace dreampm::farm {

struct Command {
  std::vector<std::string> words;  ///< the program and what follows it
  std::filesystem::path said;      ///< the file that takes what it prints
};

/// Runs all of them, `jobs` at once, and calls `ended` with the index and the exit code of each as
/// it ends (128 + the signal for one that was killed). When a stop is asked for, those that run are
/// sent SIGTERM, and awaited; no others start: throws Interrupted. Throws RunError for a program
/// that cannot be started. Calls `meanwhile` every second.
void run_all(const std::vector<Command>& commands, int jobs, const std::function<void(std::size_t, int)>& ended,
             const std::function<void()>& meanwhile);

}  // namespace dreampm::farm
