#include "dreampm/farm/wedge_runs.h"

#include <algorithm>
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

/// Files of frames in a folder of the run.
std::size_t frames_in(const fs::path& folder, const char* extension, int most) {
  std::size_t count = 0;
  std::error_code gone;  // a run that starts again removes files meanwhile
  for (fs::directory_iterator file(folder, gone), end; !gone && file != end; file.increment(gone))
    if (file->path().extension() == extension) ++count;
  return std::min(count, static_cast<std::size_t>(most));
}

/// How far all runs are: frames that are simulated, and frames that are drawn.
class WedgeProgress {
 public:
  WedgeProgress(const Wedge& wedge, const WedgeOptions& options)
      : wedge_(wedge), options_(options), progress_("wedge: frame", total()) {}

  void show(std::size_t ended) {
    std::size_t done = 0;
    for (std::size_t r = 0; r < wedge_.runs.size(); ++r) {
      const fs::path run = options_.folder / wedge_.runs[r].name;
      done += frames_in(run / "particles", ".ply", options_.frames[r]);
      done += frames_in(run / "render", ".png", options_.frames[r]);
    }
    progress_.update(done, fmt::format("{} of {} runs", ended, wedge_.runs.size()));
  }

 private:
  std::size_t total() const {
    std::size_t sum = 0;
    for (const int frames : options_.frames) sum += 2 * static_cast<std::size_t>(frames);
    return sum;
  }
  const Wedge& wedge_;
  const WedgeOptions& options_;
  Progress progress_;
};

/// Makes the runs; returns what is to be said of those that failed.
std::vector<std::string> run_wedge(const Wedge& wedge, const WedgeOptions& options) {
  const std::vector<Command> commands = commands_of(wedge, options);
  std::vector<std::string> failed;
  WedgeProgress progress(wedge, options);
  std::size_t done = 0;
  progress.show(0);
  const auto ended = [&](std::size_t index, int code) {
    ++done;
    if (code == 0) return;
    failed.push_back(fmt::format("{}: {}", wedge.runs[index].name, last_line(commands[index].said)));
    warn("{}", failed.back());
  };
  run_all(commands, options.jobs, ended, [&] { progress.show(done); });
  progress.show(done);
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
