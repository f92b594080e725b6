#include "verbs.h"

#include <charconv>
#include <sstream>

#include "dreampm/backend/cpu/cpu.h"
#include "dreampm/backend/registry.h"

namespace dreampm::cli {

CLI::App* add_verb(CLI::App& app, const std::string& name, const std::string& about, const std::string& example) {
  CLI::App* verb = app.add_subcommand(name, about);
  std::string footer = "\nExample:";
  std::istringstream lines(example);
  for (std::string line; std::getline(lines, line);) footer += "\n  " + line;
  verb->footer(footer);
  return verb;
}

const CLI::App& find_verb(const CLI::App& app, std::span<const std::string>& words) {
  const CLI::App* verb = &app;
  for (; !words.empty(); words = words.subspan(1)) {
    std::vector<std::string> names;
    const CLI::App* next = nullptr;
    for (const CLI::App* one : verb->get_subcommands([](const CLI::App*) { return true; })) {
      names.push_back(one->get_name());
      if (one->get_name() == words[0]) next = one;
    }
    if (names.empty()) break;
    if (!next) fail_input("no verb '{}'{}", words[0], scene::suggest(words[0], names));
    verb = next;
  }
  return *verb;
}

void SceneArguments::add_to(CLI::App& verb) {
  verb.add_option("SCENE", file, "scene file (YAML)")->required();
  verb.add_option("--variant", variant, "one of the scene's variants");
  verb.add_option("--set", overrides,
                  "PATH=VALUE: another value for a key, such as space.spacing=0.01; may be repeated")
      ->type_size(1)
      ->expected(-1)
      ->allow_extra_args(false);
}

void SceneArguments::add_model_to(CLI::App& verb) {
  verb.add_option("--model", mesh,
                  "a mesh in place of the scene's only one, made smaller where walls ask for it: a file or asset:knot");
}

scene::ParseResult SceneArguments::parse() const {
  if (!std::filesystem::exists(file)) fail_input("{}: no such scene file", file);
  return scene::parse_scene(file, {.variant = variant, .overrides = overrides, .assets = asset_names()});
}

model::Scene SceneArguments::load() const {
  scene::ParseResult result = parse();
  std::string errors;
  for (const scene::Problem& p : result.problems)
    if (p.warning)
      log_info(p.text());
    else
      errors += (errors.empty() ? "" : "\n") + p.text();
  if (!errors.empty()) throw InputError(errors);
  if (!mesh.empty()) replace_model(result.scene, mesh);
  return std::move(result.scene);
}

SceneSource SceneArguments::source() const {
  return {file, variant.empty() ? std::nullopt : std::optional<std::string>(variant)};
}

CLI::Validator whole_number(std::uint64_t min, std::uint64_t max) {
  const bool any = max == std::numeric_limits<std::uint64_t>::max();
  const auto read = [min, max, any](std::string& text) -> std::string {
    std::uint64_t n = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, n);
    if (error == std::errc{} && stop == end && n >= min && n <= max) return text = std::to_string(n), std::string();
    return fmt::format("{} is no whole number from {} to {}", text.empty() ? "nothing" : text, min, max);
  };
  return CLI::Validator(read, any ? fmt::format("{} or more", min) : fmt::format("in [{} - {}]", min, max));
}

CLI::Validator number_in(double min, double max) {
  const auto check = [min, max](std::string& text) -> std::string {
    double n = 0;
    if (CLI::detail::lexical_cast(text, n) && n >= min && n <= max) return {};
    return fmt::format("{} is no number from {} to {}", text.empty() ? "nothing" : text, min, max);
  };
  return CLI::Validator(check, fmt::format("in [{} - {}]", min, max));
}

const std::map<std::string, exchange::Up>& ups() {
  static const std::map<std::string, exchange::Up> all{{"y", exchange::Up::y}, {"z", exchange::Up::z}};
  return all;
}

std::vector<std::string> given(const std::vector<CLI::Option*>& options) {
  std::vector<std::string> names;
  for (const CLI::Option* o : options)
    if (o->count() > 0) names.push_back(o->get_name());
  return names;
}

bool names_run(const std::vector<std::string>& names, const std::vector<std::string>& of_files) {
  // A name that does not exist is taken for a run's folder unless it looks like a file.
  const std::filesystem::path first = names[0];
  const bool folder = std::filesystem::is_directory(first) ||
                      (!std::filesystem::exists(first) && !first.has_extension() && names.size() == 1);
  if (!folder) return false;
  if (names.size() > 1) fail_input("{}: is a folder, of which one is taken; else name files", names[0]);
  if (!of_files.empty()) fail_input("{} is for files; the run {} has its own in its scene", of_files[0], names[0]);
  return true;
}

std::pair<int, int> frame_range(const std::string& text) {
  const auto number = [&](std::string_view part) {
    int n = 0;
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), n);
    if (error != std::errc{} || end != part.data() + part.size() || n < 1)
      fail_input("--frames is {}: must be A-B or A:B, such as 1-24", text);
    return n;
  };
  const std::size_t dash = text.find_first_of("-:");
  const int first = number(std::string_view(text).substr(0, dash));
  const int last = dash == std::string::npos ? first : number(std::string_view(text).substr(dash + 1));
  if (last < first) fail_input("--frames is {}: the last frame lies before the first", text);
  return {first, last};
}

void add_threads(CLI::App& verb, int& threads) {
  verb.add_option("--threads", threads, "the most threads to use (default: all cores)")
      ->transform(whole_number(1, 4096));
}

void add_isa(CLI::App& verb, std::string& isa) {
  std::vector<std::string> sets{"auto"};
  for (const std::string_view set : cpu_instruction_sets()) sets.emplace_back(set);
  verb.add_option(
          "--isa", isa,
          "the instruction set of the kernels, which decides the last bits of results: auto (the widest of this "
          "machine), sse4, avx2 or avx512")
      ->check(CLI::IsMember(sets))
      ->capture_default_str();
}

void add_backend(CLI::App& verb, std::string& backend, const std::string& otherwise) {
  std::string kinds;
  for (const BackendInfo& b : backends())
    kinds += fmt::format("{}{} ({})", kinds.empty() ? "" : " or ", b.name, b.about);
  verb.add_option("--backend", backend, fmt::format("{}; default {}", kinds, otherwise))
      ->check(CLI::IsMember(backend_names()));
}

std::string grouped(std::uint64_t n) {
  const std::string digits = std::to_string(n);
  std::string text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) text += ',';
    text += digits[i];
  }
  return text;
}

std::string bytes_text(std::uint64_t n) {
  const double b = static_cast<double>(n);
  if (b < 1e6) return fmt::format("{:.0f} kB", b / 1e3);
  if (b < 1e9) return fmt::format("{:.0f} MB", b / 1e6);
  return fmt::format("{:.1f} GB", b / 1e9);
}

}  // namespace dreampm::cli
