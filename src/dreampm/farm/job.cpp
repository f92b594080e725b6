#include "dreampm/farm/job.h"

#include <algorithm>
#include <cctype>

namespace dreampm::farm {

std::vector<std::string> simulate_task(const Job& job, const JobRun& run) {
  std::vector<std::string> words{"make", run.scene, "--only", "simulate", "--out", run.folder};
  words.insert(words.end(), job.of_simulate.begin(), job.of_simulate.end());
  return words;
}

std::vector<std::string> frames_task(const Job& job, const JobRun& run, const std::string& range) {
  std::vector<std::string> words{"make", run.scene, "--only", "frames", "--frames", range, "--out", run.folder};
  words.insert(words.end(), job.of_frames.begin(), job.of_frames.end());
  return words;
}

std::vector<std::string> film_task(const JobRun& run) {
  return {"make", run.scene, "--only", "film", "--out", run.folder};
}

std::vector<std::string> table_task(const std::string& folder) { return {"wedge", folder}; }

int chunks_of(const Job& job, const JobRun& run) { return (run.frames + job.chunk - 1) / job.chunk; }

std::string shell_word(const std::string& word) {
  const bool plain = !word.empty() && std::all_of(word.begin(), word.end(), [](unsigned char c) {
    return c < 0x80 && (std::isalnum(c) || std::string_view("_./=,+:-").find(char(c)) != std::string_view::npos);
  });
  if (plain) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string shell_line(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) line += (line.empty() ? "" : " ") + shell_word(word);
  return line;
}

}  // namespace dreampm::farm
