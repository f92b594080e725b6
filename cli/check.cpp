#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "dreampm/pipeline/preflight.h"
#include "verbs.h"

namespace dreampm::cli {
namespace {
using Json = nlohmann::ordered_json;

struct CheckArguments {
  SceneArguments scene;
  bool json = false;
};

void print(const Json& json) { fmt::print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace)); }

Json problems(const scene::ParseResult& result, bool warnings) {
  Json list = Json::array();
  for (const scene::Problem& p : result.problems) {
    if (p.warning != warnings) continue;
    if (warnings)
      list.push_back(p.text());
    else
      list.push_back({{"file", p.file}, {"line", p.line}, {"column", p.column}, {"message", p.message}});
  }
  return list;
}

/// Lines "file:line:col: error: message", of which the place may lack.
Json errors_in(const std::string& text) {
  static const std::regex placed("(.*?)(?::([0-9]+):([0-9]+))?: error: (.*)");
  Json list = Json::array();
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::smatch m;
    if (std::regex_match(line, m, placed))
      list.push_back({{"file", m[1].str()},
                      {"line", m[2].matched ? std::stoi(m[2]) : 0},
                      {"column", m[3].matched ? std::stoi(m[3]) : 0},
                      {"message", m[4].str()}});
    else
      list.push_back({{"file", ""}, {"line", 0}, {"column", 0}, {"message", line}});
  }
  return list;
}

void print_json(const scene::ParseResult& result, const Preflight& p, const StageEstimate& e) {
  const auto& foam = result.scene.foam;
  Json warnings = problems(result, true);
  for (const std::string& w : p.warnings) warnings.push_back(w);
  Json json;
  json["particles"] = p.particles;
  json["dx"] = p.dx;
  if (p.inflow > 0) json["inflow"] = p.inflow;
  json["dt"] = p.dt;
  json["limiter"] = p.limiter;
  json["stages"] = p.stages;
  json["substeps_per_frame"] = p.substeps_per_frame;
  json["memory_bytes"] = p.memory_bytes;
  json["disk_bytes"] = p.disk_bytes;
  json["seconds"] = {{"simulate", p.simulate_seconds},
                     {"surface", e.surface_seconds},
                     {"render", e.render_seconds},
                     {"video", e.video_seconds}};
  if (foam) {
    const FoamEstimate f = estimate_foam(*foam, p.particles + p.inflow);
    json["foam"] = {{"most", f.most}, {"memory_bytes", f.memory_bytes}, {"frame_bytes", f.frame_bytes}};
  }
  json["notes"] = p.notes;
  json["warnings"] = warnings;
  json["errors"] = Json::array();
  print(json);
}

void print_text(const model::Scene& scene, const Preflight& p, const StageEstimate& e) {
  const Vec3i cells = scene.space.cells();
  const std::string inflow = p.inflow > 0 ? fmt::format(", and up to {} come in", grouped(p.inflow)) : "";
  fmt::print("{}: {} particles{}, {} frames at {} a second\n", scene.name, grouped(p.particles), inflow,
             scene.time.frames, scene.time.fps);
  fmt::print("  space     {} x {} x {} cells of {:.6g} m, up to [{:.10g}, {:.10g}, {:.10g}]\n", cells.x, cells.y,
             cells.z, p.dx, scene.space.end().x, scene.space.end().y, scene.space.end().z);
  std::string axes;
  for (std::size_t a = 0; a < 3; ++a)
    if (scene.space.periodic[a]) axes += fmt::format("{}{}", axes.empty() ? "" : ", ", "xyz"[a]);
  if (!axes.empty()) fmt::print("  periodic  along {}, rounded up to whole blocks of 4 cells\n", axes);
  fmt::print("  dt        {:.4g} s, limited by: {}; {:.0f} substeps a frame{}\n", p.dt, p.limiter, p.substeps_per_frame,
             p.stages > 0 ? fmt::format(", each in {} stages of viscosity", p.stages)
             : p.solid_steps > 0
                 ? fmt::format(", and {:.0f} short ones in each of what lies in the liquid", p.solid_steps)
                 : "");
  fmt::print("  memory    {}\n  disk      {}\n", bytes_text(p.memory_bytes), bytes_text(p.disk_bytes));
  fmt::print("  time      simulate {}, surface {}, render {}, video {} on {} threads\n",
             duration_text(p.simulate_seconds), duration_text(e.surface_seconds), duration_text(e.render_seconds),
             duration_text(e.video_seconds), thread_count());
  if (scene.foam) {
    const FoamEstimate foam = estimate_foam(*scene.foam, p.particles + p.inflow);
    fmt::print("  foam      at most {} grains at once: {} of memory with the matter, {} a frame on disk\n",
               grouped(foam.most), bytes_text(foam.memory_bytes), bytes_text(foam.frame_bytes));
  }
  for (const std::string& n : p.notes) fmt::print("  {}\n", n);
}

int check(const CheckArguments& a) {
  const scene::ParseResult result = a.scene.parse();
  if (!result.ok()) {
    if (a.json) print({{"warnings", problems(result, true)}, {"errors", problems(result, false)}});
    throw InputError(result.text().substr(0, result.text().size() - 1));
  }
  for (const scene::Problem& p : result.problems) log_info(p.text());
  Preflight p;
  try {
    p = preflight(result.scene, a.scene.file);
  } catch (const InputError& e) {
    if (a.json) print({{"warnings", problems(result, true)}, {"errors", errors_in(e.what())}});
    throw;
  }
  const StageEstimate e = estimate_stages(result.scene, p.particles + p.inflow);
  for (const std::string& w : p.warnings) warn("{}", w);
  if (a.json)
    print_json(result, p, e);
  else
    print_text(result.scene, p, e);
  return 0;
}

}  // namespace

void add_check(CLI::App& app, Action& action) {
  auto a = std::make_shared<CheckArguments>();
  CLI::App* verb = add_verb(app, "check", "Find every error in a scene, or say what its run will need",
                            "dreampm check scenes/dragon-splatting.yaml --variant preview");
  a->scene.add_to(*verb);
  verb->add_flag("--json", a->json, "print JSON");
  verb->callback([a, &action] { action = [a] { return check(*a); }; });
}

}  // namespace dreampm::cli
