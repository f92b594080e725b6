#include <algorithm>

#include "verbs.h"

namespace dreampm::cli {
namespace fs = std::filesystem;
namespace {

struct WedgeVerb {
  SceneArguments scene;
  FarmArguments farm;
  std::vector<std::string> keys;
  std::string out;
  int jobs = 1;
  std::vector<std::string> of_scenes;  ///< options given that only a scene takes
};

/// The scene of one run. Throws InputError with every error.
model::Scene scene_of_run(const WedgeVerb& a, const farm::Wedge& wedge, const farm::WedgeRun& run) {
  scene::ParseOptions options{
      .variant = a.scene.variant, .overrides = a.scene.overrides, .overrides_from = "", .assets = asset_names()};
  const std::vector<std::string> settings = run.settings(wedge.keys);
  options.overrides.insert(options.overrides.end(), settings.begin(), settings.end());
  return scene::load_scene(a.scene.file, options);
}

/// All scenes, before anything is made: one that is refused costs nothing then.
std::vector<farm::NamedScene> scenes_of(const WedgeVerb& a, const farm::Wedge& wedge) {
  const model::Scene whole = a.scene.load();
  std::vector<farm::NamedScene> scenes;
  std::vector<std::string> errors;  // each once
  for (const farm::WedgeRun& run : wedge.runs) {
    try {
      scenes.push_back({run.name, scene_of_run(a, wedge, run)});
    } catch (const InputError& e) {
      if (std::find(errors.begin(), errors.end(), e.what()) == errors.end()) errors.emplace_back(e.what());
    }
  }
  if (errors.empty()) return scenes;
  // A name that is not there makes a new thing, of which much is missing: the nearest one says
  // more.
  for (const std::string& key : wedge.keys)
    if (const std::string wrong = scene::unknown_name(whole, key); !wrong.empty())
      throw InputError(fmt::format("{}: error: {}", key, wrong));
  std::string text;
  for (const std::string& e : errors) text += (text.empty() ? "" : "\n") + e;
  throw InputError(text);
}

/// What `dreampm make` gets besides the values.
std::vector<std::string> words_of(const WedgeVerb& a) {
  std::vector<std::string> words{a.scene.file};
  if (!a.scene.variant.empty()) words.insert(words.end(), {"--variant", a.scene.variant});
  for (const std::string& o : a.scene.overrides) words.insert(words.end(), {"--set", o});
  if (!a.farm.options.backend.empty()) words.insert(words.end(), {"--backend", a.farm.options.backend});
  if (a.farm.options.isa != "auto") words.insert(words.end(), {"--isa", a.farm.options.isa});
  const int threads = a.farm.options.threads > 0 ? a.farm.options.threads : std::max(1, thread_count() / a.jobs);
  words.insert(words.end(), {"--threads", std::to_string(threads)});
  return words;
}

void print_files(const fs::path& folder) {
  for (const fs::path& file : {farm::table_file(folder), folder / "contact-sheet.png"})
    if (fs::exists(file)) fmt::print("{}\n", file.string());
}

/// The folder of a wedge: its table and sheet are made anew.
int write_again(const WedgeVerb& a) {
  if (!a.keys.empty() || !a.of_scenes.empty())
    fail_input("{}: is a folder, whose table is made anew; {} is for a scene", a.scene.file,
               a.keys.empty() ? a.of_scenes[0] : a.keys[0]);
  if (!fs::exists(farm::table_file(a.scene.file)))
    fail_input("{}: has no wedge.csv: not a wedge's folder; dreampm wedge SCENE KEY=a,b makes one", a.scene.file);
  fmt::print("{}", farm::write_table(farm::read_wedge(farm::table_file(a.scene.file)), a.scene.file));
  print_files(a.scene.file);
  return 0;
}

int wedge(const WedgeVerb& a) {
  if (fs::is_directory(a.scene.file)) return write_again(a);
  if (a.keys.empty()) fail_input("no KEY=a,b,c: which key shall have which values, as in space.spacing=0.01,0.02");
  std::vector<farm::WedgeKey> keys;
  for (const std::string& k : a.keys) keys.push_back(farm::wedge_key(k));
  const farm::Wedge wedge = farm::wedge_of(keys);
  const std::vector<farm::NamedScene> scenes = scenes_of(a, wedge);
  const fs::path folder = a.out.empty() ? fs::path(a.scene.load().output.folder + "-wedge") : fs::path(a.out);
  if (a.farm.options.to.empty()) {
    farm::WedgeOptions options{folder, fs::read_symlink("/proc/self/exe"), words_of(a), {}, a.jobs};
    for (const farm::NamedScene& s : scenes) options.frames.push_back(s.scene.time.frames);
    farm::make_wedge(wedge, options);
    print_files(folder);
    return 0;
  }
  farm::FarmOptions options = a.farm.options;
  options.folder = folder;
  options.program = own_program(), options.source = a.scene.file;
  const farm::WrittenJob job = farm::write_wedge_job(scenes[0].scene.name + "-wedge", scenes, options);
  farm::begin_table(wedge, folder);
  info("{} runs; start them by: {}", scenes.size(), job.start);
  fmt::print("{}\n", job.file.string());
  return 0;
}

}  // namespace

void add_wedge(CLI::App& app, Action& action) {
  auto a = std::make_shared<WedgeVerb>();
  CLI::App* verb =
      add_verb(app, "wedge", "Make a scene for every combination of some keys' values, and compare them",
               "dreampm wedge scenes/dam-break.yaml space.spacing=0.04,0.03 materials.water.viscosity=0.001,1");
  a->scene.add_to(*verb);
  verb->get_option("SCENE")->description("scene file (YAML); or a wedge's folder, whose table is made anew");
  verb->add_option("KEY", a->keys, "KEY=a,b,c: a key of the scene and its values, as in space.spacing=0.01,0.02")
      ->type_size(1)
      ->expected(-1);
  std::vector<CLI::Option*> of_scenes{verb->get_option("--variant"), verb->get_option("--set")};
  of_scenes.push_back(verb->add_option("--jobs", a->jobs, "runs at once, each on its share of the cores")
                          ->capture_default_str()
                          ->transform(whole_number(1, 1024)));
  a->farm.add_to(*verb, false);
  verb->get_option("--to")->excludes(of_scenes.back());  // a farm has its own number
  for (const char* name : {"--to", "--chunk", "--backend", "--isa", "--threads"})
    of_scenes.push_back(verb->get_option(name));
  of_scenes.push_back(
      verb->add_option("--out", a->out, "the wedge's folder (default: the scene's output.folder and -wedge)"));
  verb->callback([a, of_scenes, &action] {
    a->of_scenes = given(of_scenes);
    action = [a] { return wedge(*a); };
  });
}

}  // namespace dreampm::cli
