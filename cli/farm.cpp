#include <unistd.h>

#include <cstdlib>
#include <sstream>

#include "verbs.h"

namespace dreampm::cli {
namespace fs = std::filesystem;

std::string own_program() {
  const fs::path self = fs::read_symlink("/proc/self/exe");
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const fs::path file = fs::path(folder.empty() ? "." : folder) / "dreampm";
    if (::access(file.c_str(), X_OK) != 0) continue;
    std::error_code ignored;
    return fs::equivalent(file, self, ignored) ? "dreampm" : self.string();
  }
  return self.string();
}

void FarmArguments::add_to(CLI::App& verb, bool required) {
  std::string kinds;
  std::vector<std::string> names;
  for (const farm::Format& f : farm::formats()) {
    names.push_back(f.name);
    kinds += fmt::format("{}{} ({})", kinds.empty() ? "" : ", ", f.name, f.about);
  }
  CLI::Option* to = verb.add_option("--to", options.to, kinds)->required(required)->check(CLI::IsMember(names));
  CLI::Option* chunk = verb.add_option("--chunk", options.chunk, "frames a task")
                           ->capture_default_str()
                           ->transform(whole_number(1, 1000000));
  if (!required) chunk->needs(to);
  add_backend(verb, options.backend, "cpu");
  add_isa(verb, options.isa);
  add_threads(verb, options.threads);
}

namespace {

struct FarmVerb {
  SceneArguments scene;
  FarmArguments farm;
  std::string out;
};

int write_farm(const FarmVerb& a) {
  const model::Scene scene = a.scene.load();
  farm::FarmOptions options = a.farm.options;
  options.folder = a.out.empty() ? scene.output.folder : a.out;
  options.program = own_program(), options.source = a.scene.file;
  const farm::WrittenJob job = farm::write_job(scene, options);
  info("{} frames in chunks of {}; start it by: {}", scene.time.frames, options.chunk, job.start);
  fmt::print("{}\n", job.file.string());
  return 0;
}

}  // namespace

void add_farm(CLI::App& app, Action& action) {
  auto a = std::make_shared<FarmVerb>();
  CLI::App* verb = add_verb(app, "farm", "Write a scene as a job for many machines, up to the film",
                            "dreampm farm scenes/dam-break.yaml --to openjd --chunk 10");
  a->scene.add_to(*verb);
  a->scene.add_model_to(*verb);
  a->farm.add_to(*verb, true);
  verb->add_option("--out", a->out, "the run's folder, and the job's (default: the scene's output.folder)");
  verb->callback([a, &action] { action = [a] { return write_farm(*a); }; });
}

}  // namespace dreampm::cli
