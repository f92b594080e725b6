#include "verbs.h"

namespace dreampm::cli {
namespace {

/// A part of make that is typed alone, as the tasks of a farm do.
struct Part {
  const char* name;
  bool (*make)(const model::Scene&, const SceneSource&, const MakeOptions&, const FrameRange&);
};
constexpr Part parts[] = {
    {"simulate", [](const auto& scene, const auto& source, const auto& options,
                    const FrameRange&) { return make_simulation(scene, source, options); }},
    {"frames", make_frames},
    {"film", [](const auto& scene, const auto& source, const auto& options,
                const FrameRange&) { return make_film(scene, source, options); }},
};

struct MakeArguments {
  SceneArguments scene;
  std::string out, backend, isa = "auto", only, range;
  int threads = 0;
};

/// What is asked for of the whole; prints the files that it makes. False: there was nothing to do.
bool make_asked(const MakeArguments& a, const model::Scene& scene, const MakeOptions& options) {
  if (!a.range.empty() && a.only != "frames") fail_input("--frames is for --only frames");
  if (a.only == "frames" && a.range.empty()) fail_input("--only frames needs --frames A-B: which ones");
  FrameRange frames;
  if (!a.range.empty()) std::tie(frames.first, frames.last) = frame_range(a.range);
  for (const Part& part : parts)
    if (a.only == part.name) return part.make(scene, a.scene.source(), options, frames);
  return make(scene, a.scene.source(), options);
}

int make_all(const MakeArguments& a) {
  model::Scene scene = a.scene.load();
  if (!a.out.empty()) scene.output.folder = a.out;
  const std::filesystem::path folder = scene.output.folder;
  if (!make_asked(a, scene, {.folder = folder, .threads = a.threads, .backend = a.backend, .isa = a.isa}))
    info("nothing to do: {}{} is up to date", a.range.empty() ? "" : fmt::format("frames {} of ", a.range),
         folder.string());
  if (!a.only.empty() && a.only != "film") return 0;
  fmt::print("{}\n{}\n", (folder / (scene.name + ".mp4")).string(), (folder / "contact-sheet.png").string());
  return 0;
}

}  // namespace

void add_make(CLI::App& app, Action& action) {
  auto a = std::make_shared<MakeArguments>();
  CLI::App* verb = add_verb(app, "make", "Simulate, mesh, draw and encode a scene; goes on where it stopped",
                            "dreampm make scenes/dragon-splatting.yaml --variant preview");
  a->scene.add_to(*verb);
  a->scene.add_model_to(*verb);
  verb->add_option("--out", a->out, "the run's folder (default: the scene's output.folder)");
  std::vector<std::string> names;
  for (const Part& part : parts) names.emplace_back(part.name);
  verb->add_option("--only", a->only, "one part, as a task of a farm: simulate, frames or film")
      ->check(CLI::IsMember(names));
  verb->add_option("--frames", a->range,
                   "with --only frames: frames A-B, or A:B, both included; others may be made at the same time");
  add_backend(*verb, a->backend, "the one that made the run which is there, else cpu");
  add_isa(*verb, a->isa);
  add_threads(*verb, a->threads);
  verb->callback([a, &action] { action = [a] { return make_all(*a); }; });
}

}  // namespace dreampm::cli
