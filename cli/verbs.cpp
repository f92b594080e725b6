#include "verbs.h"

#include <charconv>

namespace dreampm::cli {

CLI::App* add_verb(CLI::App& app, const std::string& name, const std::string& about, const std::string& example) {
  CLI::App* verb = app.add_subcommand(name, about);
  verb->footer("\nExample:\n  " + example);
  return verb;
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

scene::ParseResult SceneArguments::parse() const {
  if (!std::filesystem::exists(file)) fail_input("{}: no such scene file", file);
  return scene::parse_scene(file, {.variant = variant, .overrides = overrides, .assets = asset_names()});
}

SceneDescription SceneArguments::load() const {
  scene::ParseResult result = parse();
  std::string errors;
  for (const scene::Problem& p : result.problems)
    if (p.warning)
      log_info(p.text());
    else
      errors += (errors.empty() ? "" : "\n") + p.text();
  if (!errors.empty()) throw InputError(errors);
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

void add_threads(CLI::App& verb, int& threads) {
  verb.add_option("--threads", threads, "the most threads to use (default: all cores)")
      ->transform(whole_number(1, 4096));
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
