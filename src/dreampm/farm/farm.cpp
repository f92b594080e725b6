#include "dreampm/farm/farm.h"

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/pipeline/estimate.h"
#include "dreampm/pipeline/models.h"
#include "dreampm/scene/problem.h"

namespace dreampm::farm {
namespace fs = std::filesystem;
namespace {

const Format& format_of(const std::string& name) {
  std::vector<std::string> names;
  for (const Format& f : formats()) {
    if (f.name == name) return f;
    names.push_back(f.name);
  }
  fail_input("no format '{}'{}", name, scene::suggest(name, names));
}

void check(const model::Scene& scene, const std::string& source) {
  std::string refused;
  for (const std::string& e : refused_later(scene))
    refused += fmt::format("{}{}: error: {}", refused.empty() ? "" : "\n", source, e);
  if (!refused.empty()) throw InputError(refused);
  with_kept_models(scene);  // reads every model
}

Job new_job(const std::string& name, const FarmOptions& options) {
  if (options.chunk < 1) fail_input("chunk is {}: must be 1 or more", options.chunk);
  Job job;
  job.name = name;
  job.chunk = options.chunk;
  job.program = options.program;
  if (!options.backend.empty()) job.of_simulate = {"--backend", options.backend};
  if (options.isa != "auto") job.of_simulate.insert(job.of_simulate.end(), {"--isa", options.isa});
  if (options.threads > 0)
    for (auto* words : {&job.of_simulate, &job.of_frames})
      words->insert(words->end(), {"--threads", std::to_string(options.threads)});
  return job;
}

WrittenJob write(const Job& job, const FarmOptions& options) {
  const Format& format = format_of(options.to);
  const fs::path file = options.folder / format.file;
  replace_file_text(file, format.text(job));
  return {file, format.start(job, file)};
}

}  // namespace

WrittenJob write_job(const model::Scene& scene, const FarmOptions& options) {
  format_of(options.to);
  check(scene, options.source);
  Job job = new_job(scene.name, options);
  job.runs.push_back({scene.name, "farm/scene.yaml", ".", scene.time.frames});
  make_folder(options.folder / "farm");
  write_portable_scene(scene, options.folder / "farm" / "scene.yaml");
  return write(job, options);
}

WrittenJob write_wedge_job(const std::string& name, const std::vector<NamedScene>& scenes, const FarmOptions& options) {
  format_of(options.to);
  for (const NamedScene& s : scenes) check(s.scene, options.source);
  Job job = new_job(name, options);
  job.is_wedge = true;
  make_folder(options.folder / "farm");
  for (const NamedScene& s : scenes) {
    job.runs.push_back({s.name, "farm/" + s.name + ".yaml", s.name, s.scene.time.frames});
    write_portable_scene(s.scene, options.folder / job.runs.back().scene);
  }
  return write(job, options);
}

}  // namespace dreampm::farm
