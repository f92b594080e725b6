#include <map>

#include "verbs.h"

namespace dreampm::cli {
namespace {

const std::map<std::string, Pattern> patterns{
    {"jitter", Pattern::jitter}, {"lattice", Pattern::lattice}, {"poisson", Pattern::poisson}};

struct PointsArguments {
  PointsRequest request;
  std::string pattern = "jitter", out;
};

int points(const PointsArguments& a) {
  PointsRequest request = a.request;
  request.pattern = patterns.at(a.pattern);
  std::filesystem::path stem = request.model;
  if (is_asset(request.model)) stem = request.model.substr(request.model.find(':') + 1);
  if (stem.extension() == ".gz" || stem.extension() == ".GZ") stem.replace_extension();
  const std::filesystem::path file = a.out.empty() ? stem.stem().string() + "-points.ply" : a.out;
  const PointsReport report = write_points(request, file);
  for (const std::string& w : report.warnings) warn("{}", w);
  const double sum = static_cast<double>(report.points) * std::pow(request.spacing, 3);
  fmt::print("{}: {} points, {:.6g} m^3 together\n", file.string(), grouped(report.points), sum);
  if (report.volume)
    fmt::print("  the model holds {:.6g} m^3 ({:+.2f} %); {} outside it\n", *report.volume,
               (sum / *report.volume - 1) * 100, report.outside == 0 ? "none" : grouped(report.outside));
  else
    fmt::print("  a cloud of points: taken over one by one, not thinned\n");
  const double nearest = report.nearest / request.spacing;
  fmt::print("  the nearest two are {:.3f} spacings apart{}\n", nearest, nearest < 1 ? "" : " or more");
  return 0;
}

}  // namespace

void add_points(CLI::App& app, Action& action) {
  auto a = std::make_shared<PointsArguments>();
  CLI::App* verb = add_verb(app, "points", "Fill a model with points and write them as PLY",
                            "dreampm points asset:knot --spacing 0.01 --fit 0.5 --out knot.ply");
  verb->add_option("MODEL", a->request.model,
                   "PLY, OBJ, STL, glTF, OFF or VTK, a cloud of points (PLY, VTK, classic bgeo), or asset:NAME")
      ->required();
  verb->add_option("--spacing", a->request.spacing, "distance between points [m]")->required();
  auto* fit = verb->add_option("--fit", a->request.longest, "make the longest side so long [m]");
  verb->add_option("--scale", a->request.scale, "or multiply all lengths by this")->excludes(fit);
  verb->add_option("--pattern", a->pattern, "jitter, lattice or poisson")
      ->check(CLI::IsMember(patterns))
      ->capture_default_str();
  verb->add_option("--out", a->out, "file to write (default: MODEL-points.ply in the working folder)");
  verb->callback([a, &action] { action = [a] { return points(*a); }; });
}

}  // namespace dreampm::cli
