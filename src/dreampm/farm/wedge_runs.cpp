#include "dreampm/farm/wedge_runs.h"

#include <sstream>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/base/log.h"
#include "dreampm/base/progress.h"
#include "dreampm/farm/processes.h"
#include "dreampm/farm/wedge_sheet.h"
#include "dreampm/farm/wedge_table.h"
#include "dreampm/pipeline/run_lock.h"

namespace dreampm::farm {
namespace fs = std::filesystem;
namespace {

std::string last_line(const fs::path& file) {
  std::istringstream lines(read_file(file));
  std::string line, last;
  while (std::getline(lines, line))
    if (!line.empty()) last = line;
  return last;
}

std::vector<Command> commands_of(const Wedge& wedge, const WedgeOptions& options) {
  std::vector<Command> commands;
  for (const WedgeRun& run : wedge.runs) {
    Command& c = commands.emplace_back();
    c.words = {options.program.string(), "make"};
    c.words.insert(c.words.end(), options.scene.begin(), options.scene.end());
    for (const std::string& s : run.settings(wedge.keys)) c.words.insert(c.words.end(), {"--set", s});
    c.words.insert(c.words.end(), {"--out", (options.folder / run.name).string()});
    c.said = options.folder / "log" / (run.name + ".txt");
  }
  return commands;
}

/// Makes the runs; returns what is to be said of those that failed.
std::vector<std::string> run_wedge(const Wedge& wedge, const WedgeOptions& options) {
  const std::vector<Command> commands = commands_of(wedge, options);
  std::vector<std::string> failed;
  Progress progress("wedge: run", wedge.runs.size());
  std::size_t done = 0;
  progress.update(0);
  run_all(commands, options.jobs, [&](std::size_t index, int code) {
    ++done;
    const std::string& name = wedge.runs[index].name;
    if (code != 0) {
      failed.push_back(fmt::format("{}: {}", name, last_line(commands[index].said)));
      warn("{}", failed.back());
    }
    progress.update(done, name);
  });
  return failed;
}

}  // namespace

void begin_table(const Wedge& wedge, const fs::path& folder) {
  make_folder(folder);
  replace_file_text(table_file(folder), csv_text(wedge, measure_wedge(wedge, folder)));
}

std::string write_table(const Wedge& wedge, const fs::path& folder) {
  const std::vector<WedgeRow> rows = measure_wedge(wedge, folder);
  replace_file_text(table_file(folder), csv_text(wedge, rows));
  if (!write_wedge_sheet(wedge, rows, folder, folder / "contact-sheet.png"))
    info("no run has a picture yet: there is no contact sheet");
  return screen_text(wedge, rows);
}

void make_wedge(const Wedge& wedge, const WedgeOptions& options) {
  RunLock lock(options.folder);
  make_folder(options.folder / "log");
  lock.keep();
  begin_table(wedge, options.folder);
  std::vector<std::string> failed;
  try {
    failed = run_wedge(wedge, options);
  } catch (const Interrupted&) {
    fmt::print("{}", write_table(wedge, options.folder));
    throw Interrupted("interrupted; what is done is kept: type the same command again to go on");
  }
  fmt::print("{}", write_table(wedge, options.folder));
  if (failed.empty()) return;
  std::string text = fmt::format("{} of {} runs failed", failed.size(), wedge.runs.size());
  for (const std::string& f : failed) text += "\n  " + f;
  throw RunError(text);
}

}  // namespace dreampm::farm
