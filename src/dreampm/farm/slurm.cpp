// Slurm: a script that submits the tasks by sbatch, chunks of frames as arrays
// (https://slurm.schedmd.com/sbatch.html).
#include <fmt/format.h>

#include <algorithm>

#include "dreampm/farm/formats.h"

namespace dreampm::farm {
namespace {

// Slurm's MaxArraySize is 1001 unless a site sets another.
constexpr int longest_array = 1000;

constexpr const char* beginning = R"sh(#!/bin/bash
# Written by `dreampm farm` or `dreampm wedge`. Submits the tasks and ends; options of sbatch may follow its name:
#   bash slurm.sh --partition=film --cpus-per-task=16
# DREAMPM=/path/to/dreampm: another program. All machines must see this folder. Submitted again, each task goes on where
# it stopped. What they print lies in farm/log.
set -euo pipefail
cd "$(dirname "$0")"
mkdir -p farm/log
)sh";

constexpr const char* functions = R"sh(options=("$@")
# NAME AFTER LINE [OPTION...]: prints the number of the job, which starts when AFTER is done. A task gets SIGTERM two
# minutes before its time is up, and saves; one whose task before it failed is taken out of the queue.
submit() {
  local name=$1 after=$2 line=$3
  shift 3
  local number
  number=$(sbatch --parsable --requeue --kill-on-invalid-dep=yes --signal=B:TERM@120 --job-name="$name" \
    --output="farm/log/%x-%j.log" ${after:+--dependency=afterok$after} ${options[@]+"${options[@]}"} "$@" --wrap="$line")
  echo "${number%%;*}"
}
films=
)sh";

/// A task as a line of a shell, in quotes for the script.
std::string quoted_task(const std::vector<std::string>& words, const std::string& before = {}) {
  return shell_word(before + "exec \"$DREAMPM\" " + shell_line(words));
}

/// The chunks from `first` on, as one array.
std::string array(const Job& job, const JobRun& run, int first) {
  const int count = std::min(longest_array, chunks_of(job, run) - first);
  const std::string range = fmt::format("first=$(({} + SLURM_ARRAY_TASK_ID * {})); last=$((first + {})); ",
                                        first * job.chunk + 1, job.chunk, job.chunk - 1);
  const std::string at_end = fmt::format("[ $last -le {0} ] || last={0}; ", run.frames);
  // The range is for the shell that runs the task.
  std::string line = quoted_task(frames_task(job, run, "FIRST-LAST"), range + at_end);
  constexpr std::string_view option = " --frames ";
  line.replace(line.find(std::string(option) + "FIRST-LAST") + option.size(), 10, "$first-$last");
  return fmt::format("frames+=:$(submit {} \":$simulate\" {} --array=0-{})\n", shell_word(run.name + "-frames"), line,
                     count - 1);
}

std::string slurm_script(const Job& job) {
  std::string text = beginning;
  text += fmt::format("export DREAMPM=${{DREAMPM:-{}}}\n{}", shell_word(job.program), functions);
  for (const JobRun& run : job.runs) {
    text += fmt::format("\n# {}\nsimulate=$(submit {} '' {})\nframes=\n", run.name, shell_word(run.name + "-simulate"),
                        quoted_task(simulate_task(job, run)));
    for (int first = 0; first < chunks_of(job, run); first += longest_array) text += array(job, run, first);
    text += fmt::format("film=$(submit {} \"$frames\" {})\nfilms+=:$film\n", shell_word(run.name + "-film"),
                        quoted_task(film_task(run)));
  }
  if (job.is_wedge)
    text += fmt::format("\nlast=$(submit {} \"$films\" {})\n", shell_word(job.name + "-table"),
                        quoted_task(table_task(".")));
  return text + fmt::format("echo \"submitted; the last job is {}\"\n", job.is_wedge ? "$last" : "$film");
}

std::string start_slurm(const Job&, const std::filesystem::path& file) { return "bash " + shell_word(file.string()); }

}  // namespace

Format slurm_format() {
  return {"slurm", "a script that submits arrays of sbatch", "slurm.sh", slurm_script, start_slurm};
}

}  // namespace dreampm::farm
