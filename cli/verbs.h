// The verbs of the command, one file each. Every function adds its verb to the app; what the verb
// does is called after the whole line was read.
#pragma once
#include <CLI/CLI.hpp>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "library.h"

namespace dreampm::cli {

/// The action of the chosen verb; its result is the exit code.
using Action = std::function<int()>;

#ifdef DM_APP
#define DM_APP_VERBS(VERB) VERB(play)
void add_bench_play(CLI::App& bench, Action& action);
#else
#define DM_APP_VERBS(VERB)
#endif
/// The verbs in the order of --help. A verb NAME is a row here, and a file of this folder that
/// defines add_NAME.
#define DM_VERBS(VERB) \
  VERB(make)           \
  DM_APP_VERBS(VERB)   \
  VERB(run)            \
  VERB(points)         \
  VERB(foam)           \
  VERB(surface)        \
  VERB(render)         \
  VERB(video)          \
  VERB(export)         \
  VERB(farm)           \
  VERB(wedge)          \
  VERB(check)          \
  VERB(info)           \
  VERB(materials)      \
  VERB(schema)         \
  VERB(validate)       \
  VERB(bench)          \
  VERB(help)           \
  VERB(completion)     \
  VERB(manual)
#define DM_DECLARE(name) void add_##name(CLI::App& app, Action& action);
DM_VERBS(DM_DECLARE)
#undef DM_DECLARE

/// A verb with its example, shown by --help; an example may have several lines.
CLI::App* add_verb(CLI::App& app, const std::string& name, const std::string& about, const std::string& example);

/// The verb that the first words name, such as "bench step"; these are taken off `words`. Throws
/// InputError with the nearest name for a word that is no verb where there are verbs.
const CLI::App& find_verb(const CLI::App& app, std::span<const std::string>& words);

/// SCENE, --variant and --set, which several verbs share.
struct SceneArguments {
  std::string file, variant, mesh;
  std::vector<std::string> overrides;

  void add_to(CLI::App& verb);
  /// --model, for verbs that make a scene.
  void add_model_to(CLI::App& verb);
  scene::ParseResult parse() const;
  /// The scene, with the mesh that --model names; its warnings are logged. Throws InputError with
  /// every error on a line of its own.
  model::Scene load() const;
  SceneSource source() const;
};

/// A whole number from `min` to `max` in plain digits, for Option::transform. CLI11's own
/// conversion wraps what is negative or too large for an unsigned number, and reads 010 as 8.
CLI::Validator whole_number(std::uint64_t min, std::uint64_t max = std::numeric_limits<std::uint64_t>::max());

/// A number from `min` to `max`, for Option::check. CLI::Range lets nan through.
CLI::Validator number_in(double min, double max);

/// y and z, for --up.
const std::map<std::string, exchange::Up>& ups();

/// The options that were given, by name.
std::vector<std::string> given(const std::vector<CLI::Option*>& options);

/// True if `names` are the folder of a run, and not files. Throws InputError for an option that
/// only files take, and for a folder among others.
bool names_run(const std::vector<std::string>& names, const std::vector<std::string>& of_files);

/// Returns the range of "A-B", "A:B" or "A". Throws InputError.
std::pair<int, int> frame_range(const std::string& text);

/// --threads, shared by the verbs that compute.
void add_threads(CLI::App& verb, int& threads);

/// --isa, shared by the verbs that simulate.
void add_isa(CLI::App& verb, std::string& isa);

/// --backend, shared by the verbs that simulate. `otherwise`: what is taken without it.
void add_backend(CLI::App& verb, std::string& backend, const std::string& otherwise);

/// What starts this very program: its name if the PATH leads to it, else where it lies.
std::string own_program();

/// --to, --chunk and what else jobs for a farm are asked for by; `folder` stays to be set.
struct FarmArguments {
  farm::FarmOptions options;
  void add_to(CLI::App& verb, bool required);
};

/// "1,234,567", "310 MB".
std::string grouped(std::uint64_t n);
std::string bytes_text(std::uint64_t n);

}  // namespace dreampm::cli
