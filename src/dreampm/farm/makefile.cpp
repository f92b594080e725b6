// A makefile: the tasks as goals that depend on one another.
#include <fmt/format.h>

#include <algorithm>

#include "dreampm/farm/formats.h"

namespace dreampm::farm {
namespace {

/// Make reads $$ as $.
std::string escaped(const std::string& text) {
  std::string line;
  for (const char c : text) line += c == '$' ? std::string("$$") : std::string(1, c);
  return line;
}

std::string recipe(const std::vector<std::string>& words) {
  return "\t$(DREAMPM) " + escaped(shell_line(words)) + "\n";
}

/// A variable's value, in which # begins a comment.
std::string value(const std::string& word) {
  std::string text;
  for (const char c : escaped(shell_word(word))) text += c == '#' ? std::string("\\#") : std::string(1, c);
  return text;
}

std::string goals_of(const Job& job, std::size_t number) {
  const JobRun& run = job.runs[number];
  const std::size_t n = number + 1;
  std::string frames, text = fmt::format("\n# {}\nsimulate-{}:\n{}", run.name, n, recipe(simulate_task(job, run)));
  for (int c = 0; c < chunks_of(job, run); ++c) {
    const std::string range = fmt::format("{}-{}", c * job.chunk + 1, std::min(run.frames, (c + 1) * job.chunk));
    const std::string goal = fmt::format("frames-{}-{}", n, c + 1);
    text += fmt::format("{}: simulate-{}\n{}", goal, n, recipe(frames_task(job, run, range)));
    frames += " " + goal;
  }
  return text +
         fmt::format("film-{}:{}\n{}.PHONY: simulate-{}{} film-{}\n", n, frames, recipe(film_task(run)), n, frames, n);
}

std::string makefile(const Job& job) {
  std::string films, goals;
  for (std::size_t r = 0; r < job.runs.size(); ++r) {
    films += fmt::format(" film-{}", r + 1);
    goals += goals_of(job, r);
  }
  std::string text =
      "# Written by `dreampm farm` or `dreampm wedge`: type `make -j2` in this folder. Each goal goes on where it\n"
      "# stopped and leaves what is up to date. DREAMPM=/path/to/dreampm: another program.\n";
  text += fmt::format("DREAMPM ?= {}\n.PHONY: all\n", value(job.program));
  if (!job.is_wedge) return text + "all:" + films + "\n" + goals;
  return text + "all: table\n" + goals + "\n.PHONY: table\ntable:" + films + "\n" + recipe(table_task("."));
}

std::string start_make(const Job&, const std::filesystem::path& file) {
  const std::string folder = file.parent_path().empty() ? "." : file.parent_path().string();
  return fmt::format("make -C {} -j2", shell_word(folder));
}

}  // namespace

Format make_format() { return {"make", "a makefile for make -jN", "Makefile", makefile, start_make}; }

}  // namespace dreampm::farm
