// A job of a farm: scenes whose runs are cut into tasks for many machines.
#pragma once
#include <string>
#include <vector>

namespace dreampm::farm {

/// A run of the job. Its paths count from the job's folder.
struct JobRun {
  std::string name;    ///< unique in the job, of letters, digits and "=,._+-"
  std::string scene;   ///< the scene file that travels along
  std::string folder;  ///< of the run
  int frames = 1;
};

struct Job {
  std::string name;
  std::vector<JobRun> runs;
  int chunk = 10;                        ///< frames a task
  std::string program = "dreampm";       ///< what machines start; can be replaced where the job is started
  std::vector<std::string> of_simulate;  ///< options of the task that simulates,
  std::vector<std::string> of_frames;    ///< and of those that make frames
  bool is_wedge = false;                 ///< ends with a table and a contact sheet of all runs
};

/// The task that simulates a run: what follows the program's name. It goes on where an earlier one
/// stopped.
std::vector<std::string> simulate_task(const Job& job, const JobRun& run);
/// Some frames of a run, once it is simulated; `range` is A-B.
std::vector<std::string> frames_task(const Job& job, const JobRun& run, const std::string& range);
/// The film, once all frames are made.
std::vector<std::string> film_task(const JobRun& run);
/// The table and the sheet of a wedge in `folder`, once all films are made.
std::vector<std::string> table_task(const std::string& folder);

/// Number of tasks that make the frames of a run.
int chunks_of(const Job& job, const JobRun& run);

/// A word that a shell takes as it is.
std::string shell_word(const std::string& word);
/// Words as a line of a shell.
std::string shell_line(const std::vector<std::string>& words);

}  // namespace dreampm::farm
