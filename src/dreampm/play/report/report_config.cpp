#include "dreampm/play/report/report_config.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/scene/fields.h"

namespace dreampm::play {
namespace {

using scene::between;
using scene::count;
using scene::Field;
using scene::number;
using scene::Problems;
using scene::Range;
using scene::Reading;
using scene::Schema;
using scene::text;
using scene::YamlNode;

/// A list, each item of which `each` reads.
template <class T>
Field<T> list(std::string key, std::function<void(Reading&, const YamlNode&, const std::string& path, T&)> each) {
  return {std::move(key),
          [each = std::move(each)](Reading& in, const YamlNode& n, const std::string& path, T& out) {
            if (!expect_list(in.problems, n, path)) return;
            if (n.items.empty()) in.problems.error(n.at, fmt::format("{} is empty: give at least one", path));
            for (std::size_t i = 0; i < n.items.size(); ++i) each(in, n.items[i], fmt::format("{}[{}]", path, i), out);
          },
          {}};
}

Field<ReportMaterial> id() {
  return {"id",
          [](Reading& in, const YamlNode& n, const std::string& path, ReportMaterial& out) {
            const auto v = read_count(in.problems, n, path, std::numeric_limits<std::int64_t>::min(),
                                      std::numeric_limits<std::int64_t>::max());
            if (v && *v != diy_material && *v != solid_cube)
              in.problems.error(n.at, fmt::format("{} is {}: must be {} (the DIY material) or {} (the solid cube)",
                                                  path, *v, diy_material, solid_cube));
            else if (v)
              out.id = int(*v);
          },
          {}};
}

Field<ReportMaterial> default_color() {
  return {"default color",
          [](Reading& in, const YamlNode& n, const std::string& path, ReportMaterial& out) {
            const bool is_list = n.kind == YamlNode::Kind::list;
            if (!is_list || n.items.size() != out.color.size()) {
              const std::string is = is_list ? fmt::format("a list of {}", n.items.size()) : n.describe();
              return in.problems.error(
                  n.at, fmt::format("{} is {}: must be a list of 4 numbers, [red, green, blue, opacity]", path, is));
            }
            for (std::size_t i = 0; i < out.color.size(); ++i)
              if (auto v = read_number(in.problems, n.items[i], fmt::format("{}[{}]", path, i), between(0, 1)))
                out.color[i] = *v;
          },
          {}};
}

const Schema<ReportMaterial>& material_schema() {
  static const Schema<ReportMaterial> schema{id().must(), text("name", &ReportMaterial::name).must(),
                                             default_color().must()};
  return schema;
}

Field<ReportPreset> vectors(std::string key, std::vector<Vec3d> ReportPreset::* member, Range range) {
  return list<ReportPreset>(std::move(key),
                            [=](Reading& in, const YamlNode& n, const std::string& path, ReportPreset& out) {
                              if (auto v = read_vector(in.problems, n, path, range)) (out.*member).push_back(*v);
                            });
}

const Schema<ReportPreset>& preset_schema() {
  static const Schema<ReportPreset> schema{
      text("name", &ReportPreset::name).must(),
      list<ReportPreset>("material",
                         [](Reading& in, const YamlNode& n, const std::string& path, ReportPreset& out) {
                           const auto v = read_count(in.problems, n, path, 0, std::numeric_limits<int>::max());
                           if (v) out.material.push_back(int(*v));
                         })
          .must(),
      vectors("minimum", &ReportPreset::minimum, between(0, 1)).must(),
      vectors("size", &ReportPreset::size, {0, 1, true, false}).must(),
  };
  return schema;
}

void read_material(Reading& in, const YamlNode& n, const std::string& path, ReportConfig& out) {
  ReportMaterial m;
  read_map(in, n, path, material_schema(), m);
  const YamlNode* at = n.find("id");
  for (const ReportMaterial& other : out.materials)
    if (at && other.id == m.id)
      in.problems.error(at->at, fmt::format("{}.id is {}, as that of {}: give each material its own", path, m.id,
                                            other.name.empty() ? "one before" : other.name));
  out.materials.push_back(std::move(m));
}

/// What no single key can know; the keys themselves were right.
void check_preset(Problems& problems, const YamlNode& n, const std::string& path, const ReportPreset& preset,
                  const std::vector<ReportMaterial>& materials) {
  const YamlNode &ids = *n.find("material"), &minimum = *n.find("minimum"), &size = *n.find("size");
  for (const auto& [key, node] : {std::pair{"minimum", &minimum}, std::pair{"size", &size}})
    if (node->items.size() != ids.items.size())
      return problems.error(node->at, fmt::format("{}.{} has {} entries and {}.material {}: must be one each for every "
                                                  "object",
                                                  path, key, node->items.size(), path, ids.items.size()));
  for (std::size_t i = 0; i < preset.material.size(); ++i) {
    const auto known = [&](const ReportMaterial& m) { return m.id == preset.material[i]; };
    if (std::none_of(materials.begin(), materials.end(), known)) {
      std::vector<std::string> words;
      for (const ReportMaterial& m : materials) words.push_back(fmt::format("{} ({})", m.id, m.name));
      problems.error(
          ids.items[i].at,
          fmt::format("{}.material[{}] is {}: there is no material of that id{}", path, i, preset.material[i],
                      words.empty() ? "" : fmt::format("; known: {}", fmt::join(words, ", "))));
    }
    for (int a = 0; a < 3; ++a) {
      const double end = preset.minimum[i][a] + preset.size[i][a];
      // As in 0.7 + 0.3.
      if (end > 1 + 1e-9)
        problems.error(
            size.items[i].items[std::size_t(a)].at,
            fmt::format("{0}.size[{1}][{2}] is {3}: the object would end at {4:.6g}, outside of the unit cube; "
                        "with a minimum of {5} must be at most {6:.6g}",
                        path, i, a, preset.size[i][a], end, preset.minimum[i][a], 1 - preset.minimum[i][a]));
    }
  }
}

void read_preset(Reading& in, const YamlNode& n, const std::string& path, ReportConfig& out) {
  ReportPreset p;
  const int before = in.problems.errors();
  read_map(in, n, path, preset_schema(), p);
  if (in.problems.errors() == before) check_preset(in.problems, n, path, p, out.materials);
  out.presets.push_back(std::move(p));
}

const Schema<ReportConfig>& config_schema() {
  static const Schema<ReportConfig> schema{
      count("width", &ReportConfig::width, 16, 16384).must(),
      count("height", &ReportConfig::height, 16, 16384).must(),
      count("grid number", &ReportConfig::grid, 8, 256).must(),
      number("max timestep", &ReportConfig::max_time_step, {0, 100, true, false}).must(),
      number("max hard", &ReportConfig::max_hard, between(0.25, 10)).must(),
      list<ReportConfig>("materials", read_material).must(),
      list<ReportConfig>("presets", read_preset).must(),
  };
  return schema;
}

/// Blank lines and comments alone?
bool says_nothing(std::string_view text) {
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t end = std::min(text.find('\n', from), text.size());
    const std::size_t first = text.find_first_not_of(" \r", from);
    if (first < end && text[first] != '#') return false;
    from = end + 1;
  }
  return true;
}

ReportConfig read_config(std::string_view text, const std::string& name, Problems& problems) {
  ReportConfig config;
  if (says_nothing(text)) {
    problems.error({name}, "the file is empty; a config has width, height, grid number, materials and presets");
    return config;
  }
  const YamlNode root = scene::read_yaml(text, name, problems);
  if (problems.errors() > 0) return config;
  if (!expect_map(problems, root, "the config")) return config;
  Reading in{problems, "", {}};
  read_map(in, root, "", config_schema(), config);
  return config;
}

YamlNode flow(std::initializer_list<std::pair<const char*, YamlNode>> entries) {
  YamlNode map = YamlNode::map();
  for (const auto& [key, value] : entries) map.put(key, value);
  return map;
}

YamlNode word(const std::string& text) { return YamlNode::scalar(text); }

/// The solid cube of the report: mu = 416.6 Pa and lambda = 277.7 Pa, times max hard.
YamlNode cube_material(double max_hard) {
  const double mu = 416.6 * max_hard, lambda = 277.7 * max_hard;
  return flow({{"type", word("elastic")},
               {"density", scene::write_number(1)},
               {"youngs_modulus", scene::write_number(mu * (3 * lambda + 2 * mu) / (lambda + mu))},
               {"poissons_ratio", scene::write_number(lambda / (2 * (lambda + mu)))}});
}

YamlNode diy_as_at_start() {
  return flow({{"type", word("seed")},
               {"density", scene::write_number(1)},
               {"youngs_modulus", scene::write_number(1000)},
               {"v", scene::write_number(0.5)},
               {"lower", scene::write_number(-250)},
               {"upper", scene::write_number(45)},
               {"hardening", scene::write_number(10)}});
}

}  // namespace

ReportConfig parse_report_config(std::string_view text, const std::string& name) {
  Problems problems;
  ReportConfig config = read_config(text, name, problems);
  if (problems.errors() == 0) return config;
  std::vector<scene::Problem> list = problems.list();
  std::sort(list.begin(), list.end(),
            [](const auto& a, const auto& b) { return std::tie(a.line, a.column) < std::tie(b.line, b.column); });
  std::string all;
  for (const scene::Problem& p : list) all.append(all.empty() ? "" : "\n").append(p.text());
  throw InputError(all);
}

ReportConfig load_report_config(const std::filesystem::path& file) {
  return parse_report_config(read_file(file), file.string());
}

ReportConfig report_config() {
  const Vec3d quarter{0.25, 0.25, 0.25};
  ReportConfig config;
  config.materials = {{diy_material, "DIY_MATERIAL", {1, 1, 1, 1}}, {solid_cube, "SOLID_CUBE", {0.93, 0.33, 0.23, 1}}};
  config.presets = {{"DIY_MATERIAL", {diy_material}, {{0.35, 0.35, 0.35}}, {quarter}},
                    {"DIY_MATERIAL and SOLID_CUBE",
                     {solid_cube, diy_material},
                     {{0.30, 0.60, 0.30}, {0.40, 0.25, 0.40}},
                     {quarter, quarter}}};
  return config;
}

std::string report_material_name(int id) { return id == diy_material ? "diy" : "cube"; }

std::string report_scene(const ReportConfig& config, std::size_t preset) {
  if (preset >= config.presets.size())
    fail_input("there is no preset {}; the config has {}", preset + 1, config.presets.size());
  const ReportPreset& p = config.presets[preset];
  double volume = 0;
  for (const Vec3d& s : p.size) volume += s.x * s.y * s.z;
  const double cells = std::pow(config.grid, 3), particles = cells / 4;
  const double spacing = std::cbrt(volume / particles);

  YamlNode materials = YamlNode::map(), bodies = YamlNode::map(), looks = YamlNode::map();
  for (std::size_t i = 0; i < p.material.size(); ++i) {
    const bool diy = p.material[i] == diy_material;
    const std::string name = report_material_name(p.material[i]);
    if (!materials.find(name)) {
      const auto m = std::find_if(config.materials.begin(), config.materials.end(),
                                  [&](const ReportMaterial& r) { return r.id == p.material[i]; });
      if (m == config.materials.end()) fail_input("preset {}: there is no material {}", preset + 1, p.material[i]);
      materials.put(name, diy ? diy_as_at_start() : cube_material(config.max_hard));
      // Balls of 1 cm, whatever the grid.
      looks.put(name, flow({{"type", word("spheres")},
                            {"color", scene::write_vector({m->color[0], m->color[1], m->color[2]})},
                            {"radius", scene::write_number(std::clamp(0.01 / spacing, 0.001, 10.0))}}));
    }
    // Poisson: points by chance, as in the report, that keep apart.
    bodies.put(fmt::format("object_{}", i + 1),
               flow({{"material", word(name)},
                     {"shape", flow({{"box", flow({{"min", scene::write_vector(p.minimum[i])},
                                                   {"max", scene::write_vector(p.minimum[i] + p.size[i])}})}})},
                     {"sample", flow({{"pattern", word("poisson")}})}}));
  }

  YamlNode root = YamlNode::map();
  root.put("dreampm", scene::write_count(1));
  root.put("name", YamlNode::scalar(fmt::format("report-{}", preset + 1)));
  root.put("about", scene::write_text(fmt::format("The report's preset: {}", p.name)));
  root.put("space",
           flow({{"min", scene::write_vector({0, 0, 0})},
                 {"max", scene::write_vector({1, 1, 1})},
                 {"spacing", scene::write_number(spacing)},
                 {"particles_per_cell", scene::write_number(std::clamp(particles / (volume * cells), 1.0, 64.0))}}));
  root.put("time", flow({{"fps", scene::write_count(60)}, {"seconds", scene::write_count(4)}}));
  root.put("gravity", scene::write_vector({0, -9.8, 0}));
  root.put("materials", std::move(materials));
  root.put("bodies", std::move(bodies));
  root.put("render",
           flow({// Even sides, for the video.
                 {"size", YamlNode::list(
                              {scene::write_count(config.width / 2 * 2), scene::write_count(config.height / 2 * 2)})},
                 {"camera", flow({{"from", scene::write_vector({0.5, 1.0, 1.95})},
                                  {"to", scene::write_vector({0.5, 0.3, 0.5})},
                                  {"fov", scene::write_count(55)}})},
                 {"looks", std::move(looks)}}));
  return scene::write_yaml(root);
}

}  // namespace dreampm::play
