#include <map>

#include "verbs.h"

namespace dreampm::cli {
namespace {

/// Says what a number out of range is in: scenes have another unit.
CLI::Validator voxel_in_spacings() {
  const CLI::Validator range = number_in(0.125, 2);
  const auto check = [range](std::string& text) -> std::string {
    const std::string wrong = range(text);
    return wrong.empty() ? wrong : wrong + " spacings (a scene's surface.voxel is in cells)";
  };
  return CLI::Validator(check, range.get_description());
}

const std::map<std::string, model::SurfaceType> types{
    {"mesh", model::SurfaceType::mesh}, {"fog", model::SurfaceType::fog}, {"sdf", model::SurfaceType::sdf}};

struct SurfaceArguments {
  std::vector<std::string> names;
  std::string type = "mesh";
  LooseSurfaces loose;
  std::vector<std::string> of_files;  ///< options given that only files take
  int threads = 0;
};

int surface_run(const std::string& folder) {
  RunFolder run = open_run(folder, Access::write);
  if (meshed_materials(run.scene).empty())
    info("nothing to do: every material is drawn as spheres");
  else if (surface_stage(run).made == 0)
    info("nothing to do: {} is up to date", (run.folder / "surface").string());
  return 0;
}

int surface(const SurfaceArguments& a) {
  const ThreadLimit limit(a.threads);
  if (names_run(a.names, a.of_files)) return surface_run(a.names[0]);
  LooseSurfaces request = a.loose;
  request.files = a.names;
  request.type = types.at(a.type);
  for (const std::filesystem::path& f : surface_files(request)) fmt::print("{}\n", f.string());
  return 0;
}

}  // namespace

void add_surface(CLI::App& app, Action& action) {
  auto a = std::make_shared<SurfaceArguments>();
  CLI::App* verb = add_verb(app, "surface", "Wrap the particles of a run, or of files, in meshes",
                            "dreampm surface out/dragon-splatting-preview\n"
                            "dreampm surface cache/fluid_*.bgeo --spacing 0.02 --out meshes");
  verb->add_option("DIR", a->names, "a run's folder; or files of particles, each a frame")->required();
  std::vector<CLI::Option*> of_files{
      verb->add_option("--spacing", a->loose.spacing, "of files: the distance between particles, in their unit")
          ->check(number_in(1e-9, 1e9)),
      // The old name is that of a scene's key, which counts cells.
      verb->add_option("--voxel,--voxel-spacings", a->loose.voxel,
                       "of files: the edge of a voxel, in spacings; surface.voxel of a scene is in cells, of 2 "
                       "spacings at 8 particles a cell. --voxel is the same")
          ->capture_default_str()
          ->check(voxel_in_spacings()),
      verb->add_option("--smooth", a->loose.smooth, "of files: rounds of smoothing")
          ->capture_default_str()
          ->transform(whole_number(0, 10)),
      verb->add_option("--type", a->type,
                       "of files: mesh writes NAME.ply; fog and sdf write NAME.vdb, an OpenVDB fog volume of which the "
                       "surface is where it is 0.5, or a level set of distances")
          ->capture_default_str()
          ->check(CLI::IsMember(types)),
      verb->add_option(
              "--attributes", a->loose.attributes,
              fmt::format("of files: what vertices hold, of {}, with a comma between (default: velocity, where "
                          "particles have it)",
                          fmt::join(cloud_attributes(), ", ")))
          ->delimiter(',')
          ->allow_extra_args(false)
          ->check(CLI::IsMember(cloud_attributes())),
      verb->add_option("--out", a->loose.out, "of files: the folder of their meshes")->capture_default_str()};
  add_threads(*verb, a->threads);
  verb->callback([a, of_files, &action] {
    a->of_files = given(of_files);
    action = [a] { return surface(*a); };
  });
}

}  // namespace dreampm::cli
