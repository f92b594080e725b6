// Open Job Description, the format of AWS Deadline Cloud and others: a job template of
// specification jobtemplate-2023-09, whose frames are chunks by the extension TASK_CHUNKING
// (https://github.com/OpenJobDescription/openjd-specifications/wiki/2023-09-Template-Schemas).
#include <fmt/format.h>

#include <map>

#include "dreampm/base/error.h"
#include "dreampm/farm/formats.h"

namespace dreampm::farm {
namespace {

constexpr std::size_t most_values = 1024;  ///< of a task parameter, by the specification

/// A text in the double quotes of JSON, which YAML reads as the same.
std::string quoted(const std::string& text) {
  std::string q = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') q += '\\';
    q += c;
  }
  return q + "\"";
}

std::string flow_list(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& w : words) text += (text.empty() ? "" : ", ") + quoted(w);
  return "[" + text + "]";
}

/// Steps of runs of equal length: what differs among them is a parameter.
struct Group {
  std::string suffix;  ///< of the steps' names
  std::vector<JobRun> runs;
  /// The run of a task, with the places where the template's reader puts names.
  JobRun any() const {
    if (runs.size() == 1 && runs[0].folder == ".")
      return {runs[0].name, "{{Param.Folder}}/" + runs[0].scene, "{{Param.Folder}}", runs[0].frames};
    return {"{{Task.Param.Run}}", "{{Param.Folder}}/farm/{{Task.Param.Run}}.yaml",
            "{{Param.Folder}}/{{Task.Param.Run}}", runs[0].frames};
  }
  bool has_parameter() const { return !any().name.empty() && any().name[0] == '{'; }
  std::string parameter() const {
    std::vector<std::string> names;
    for (const JobRun& r : runs) names.push_back(r.name);
    return fmt::format("        - {{name: Run, type: STRING, range: {}}}\n", flow_list(names));
  }
};

/// Runs by their number of frames: that is the range of a step.
std::vector<Group> groups_of(const Job& job) {
  std::map<int, Group> by_frames;
  for (const JobRun& run : job.runs) by_frames[run.frames].runs.push_back(run);
  std::vector<Group> groups;
  for (auto& [frames, group] : by_frames) {
    if (group.runs.size() > most_values)
      fail_input("{} runs of {} frames: a template takes at most {}; wedge fewer values at once, or --to make",
                 group.runs.size(), frames, most_values);
    if (by_frames.size() > 1) group.suffix = fmt::format("Of{}", frames);
    groups.push_back(group);
  }
  return groups;
}

std::string action(const std::vector<std::string>& words) {
  // On cancellation the worker sends SIGTERM first: the simulation saves its state.
  return fmt::format(
      "    script:\n      actions:\n        onRun:\n          command: \"{{{{Param.Dreampm}}}}\"\n          args: {}\n"
      "          cancelation: {{mode: NOTIFY_THEN_TERMINATE, notifyPeriodInSeconds: 120}}\n",
      flow_list(words));
}

std::string step(const std::string& name, const std::vector<std::string>& after, const std::string& parameters,
                 const std::vector<std::string>& words) {
  std::string text = fmt::format("  - name: {}\n", name);
  if (!after.empty()) text += "    dependencies:\n";
  for (const std::string& a : after) text += fmt::format("      - dependsOn: {}\n", a);
  if (!parameters.empty()) text += "    parameterSpace:\n      taskParameterDefinitions:\n" + parameters;
  return text + action(words);
}

std::string steps_of(const Job& job, const Group& group) {
  const std::string run = group.has_parameter() ? group.parameter() : std::string();
  const std::string frames = fmt::format(
      "        - name: Frames\n          type: CHUNK[INT]\n          range: \"1-{}\"\n"
      "          chunks: {{defaultTaskCount: {}, rangeConstraint: CONTIGUOUS}}\n",
      group.runs[0].frames, job.chunk);
  const std::string simulate = "Simulate" + group.suffix, make = "Frames" + group.suffix, film = "Film" + group.suffix;
  return step(simulate, {}, run, simulate_task(job, group.any())) +
         step(make, {simulate}, run + frames, frames_task(job, group.any(), "{{Task.Param.Frames}}")) +
         step(film, {make}, run, film_task(group.any()));
}

std::string job_template(const Job& job) {
  std::string text = "# Written by `dreampm farm` or `dreampm wedge`. Each task goes on where it stopped.\n";
  text += "specificationVersion: jobtemplate-2023-09\nextensions: [TASK_CHUNKING]\n";
  text += fmt::format("name: {}\n", quoted(job.name));
  text += "parameterDefinitions:\n";
  text += "  - name: Folder\n    type: PATH\n    objectType: DIRECTORY\n    dataFlow: INOUT\n    default: .\n";
  text += "    description: The folder of this file; all machines must see it.\n";
  text += fmt::format("  - name: Dreampm\n    type: STRING\n    default: {}\n    description: The program.\n",
                      quoted(job.program));
  text += "steps:\n";
  std::vector<std::string> films;
  for (const Group& group : groups_of(job)) {
    text += steps_of(job, group);
    films.push_back("Film" + group.suffix);
  }
  if (job.is_wedge) text += step("Table", films, {}, table_task("{{Param.Folder}}"));
  return text;
}

std::string start_openjd(const Job& job, const std::filesystem::path& file) {
  return fmt::format("openjd run {} --step {} --run-dependencies", shell_word(file.string()),
                     job.is_wedge ? "Table" : "Film" + groups_of(job).back().suffix);
}

}  // namespace

Format openjd_format() {
  return {"openjd", "a job template of Open Job Description, as Deadline Cloud takes it", "template.yaml", job_template,
          start_openjd};
}

}  // namespace dreampm::farm
