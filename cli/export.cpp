#include <map>

#include "verbs.h"

namespace dreampm::cli {
namespace {

/// The parts of a frame that are exported.
struct What {
  bool particles, surface, colliders, foam;
};
const std::map<std::string, What> whats{{"particles", {true, false, false, false}},
                                        {"surface", {false, true, false, false}},
                                        {"colliders", {false, false, true, false}},
                                        {"foam", {false, false, false, true}},
                                        {"all", {true, true, true, true}}};

std::string format_names() {
  std::string names;
  for (const exchange::Format& f : exchange::formats())
    names += fmt::format("{}{} ({})", names.empty() ? "" : ", ", f.name, f.about);
  return names;
}

struct ExportArguments {
  std::string folder, up = "y", what, range;
  ExportOptions options;
};

int export_files(const ExportArguments& a) {
  ExportOptions options = a.options;
  options.axes.up = ups().at(a.up);
  options.what_there_is = a.what.empty();
  const What what = whats.at(a.what.empty() ? "all" : a.what);
  options.particles = what.particles, options.surface = what.surface;
  options.colliders = what.colliders, options.foam = what.foam;
  if (!a.range.empty()) std::tie(options.first, options.last) = frame_range(a.range);
  const ExportResult result = export_run(open_run(a.folder), options);
  for (const std::filesystem::path& f : result.files) fmt::print("{}\n", f.string());
  return 0;
}

}  // namespace

void add_export(CLI::App& app, Action& action) {
  auto a = std::make_shared<ExportArguments>();
  CLI::App* verb = add_verb(app, "export", "Write the frames of a run for other programs",
                            "dreampm export out/dam-break --to usd --up z");
  verb->add_option("DIR", a->folder, "a run's folder")->required();
  std::vector<std::string> names;
  for (const exchange::Format& f : exchange::formats()) names.push_back(f.name);
  // No library for C++ is packaged that writes Alembic: the package of Python does.
  const CLI::Validator elsewhere(
      [](std::string& name) -> std::string {
        if (name != "alembic" && name != "abc") return {};
        return "Alembic files are written by the package of Python: pip install alembic3d, then python -m "
               "dreampm.alembic "
               "DIR";
      },
      {});
  verb->add_option("--to", a->options.format, format_names())
      ->required()
      ->check(elsewhere)
      ->check(CLI::IsMember(names));
  verb->add_option("--up", a->up, "the axis that points up in the files, y or z")
      ->check(CLI::IsMember(ups()))
      ->capture_default_str();
  verb->add_option("--scale", a->options.axes.scale, "units of the files a meter, such as 100 for centimeters")
      ->capture_default_str()
      ->check(number_in(1e-6, 1e6));
  verb->add_option("--frames", a->range, "only frames A-B, or A:B, both included");
  verb->add_option("--what", a->what,
                   "particles, surface, foam, colliders (and rigid bodies) or all (default: what there is)")
      ->check(CLI::IsMember(whats));
  verb->add_option("--out", a->options.out, "the file, or the folder of files (default: in DIR/export)");
  verb->callback([a, &action] { action = [a] { return export_files(*a); }; });
}

}  // namespace dreampm::cli
