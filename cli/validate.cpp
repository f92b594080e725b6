#include <algorithm>
#include <chrono>

#include "verbs.h"

namespace dreampm::cli {
namespace {

struct Arguments {
  std::vector<std::string> cases;
  std::string out = "out/validation", markdown;
  int threads = 0;
  validate::Options options;
  bool quick = false, full = false, json = false, list = false;
};

void print_list() {
  for (const validate::Case* c : validate::all_cases())
    fmt::print("{:<20}{}{}\n", c->name, c->about, c->quick ? "" : " (only with --full)");
}

/// The named cases in the order given, or all of the level. A case asked for by name runs at either level.
std::vector<const validate::Case*> wanted(const Arguments& a, validate::Level level) {
  if (a.cases.empty() || (a.cases.size() == 1 && a.cases[0] == "all")) return validate::cases_of(level);
  std::vector<const validate::Case*> some;
  for (const std::string& name : a.cases) some.push_back(&validate::find_case(name));
  return some;
}

int run_cases(const Arguments& a) {
  if (a.list) return print_list(), 0;
  validate::Options options = a.options;
  options.level = a.full ? validate::Level::full : validate::Level::quick;
  const ThreadLimit threads(a.threads);
  const auto cases = wanted(a, options.level);
  if (options.cfl > 0 && std::none_of(cases.begin(), cases.end(), [](const auto* c) { return c->name == "stability"; }))
    fail_input("--cfl {} is for the random scenes of the case stability, which is not among those named", options.cfl);
  make_folder(a.out);
  const auto start = std::chrono::steady_clock::now();
  const auto results = validate::run_cases(cases, options, a.out, [&](const validate::Result& r) {
    if (!a.json) fmt::print("{}\n", validate::text_of(r));
    std::fflush(stdout);
  });
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (a.json)
    fmt::print("{}\n", validate::json_of(results));
  else
    fmt::print("{}", validate::summary_of(results, seconds));
  if (results.size() < cases.size()) throw Interrupted("interrupted: the cases above were done");
  if (!a.markdown.empty()) {
    const std::filesystem::path page(a.markdown);
    const auto folder = std::filesystem::relative(a.out, page.parent_path().empty() ? "." : page.parent_path());
    replace_file_text(page, validate::markdown_of(results, folder.generic_string(), seconds));
  }
  return validate::succeeded(results) ? 0 : 1;
}

}  // namespace

void add_validate(CLI::App& app, Action& action) {
  auto a = std::make_shared<Arguments>();
  CLI::App* verb = add_verb(app, "validate", "Hold the solver against experiments and exact solutions",
                            "dreampm validate still-column bar-wave --out out/validation");
  verb->add_option("CASE", a->cases, "cases by name, or all (--list names them)");
  auto* quick = verb->add_flag("--quick", a->quick, "the set of 3 minutes on 2 cores (default)");
  verb->add_flag("--full", a->full, "every case at full resolution, within 40 minutes")->excludes(quick);
  verb->add_flag("--json", a->json, "print JSON");
  verb->add_flag("--list", a->list, "only name the cases");
  verb->add_option("--out", a->out, "folder for the plots")->capture_default_str();
  verb->add_option("--markdown", a->markdown, "also write the results as a page");
  verb->add_option("--draws", a->options.draws, "of the case stability: how many random scenes (12; 200 with --full)")
      ->check(CLI::Range(1, 1000000));
  verb->add_option("--seed", a->options.seed, "of the random scenes")->capture_default_str();
  verb->add_option("--draw", a->options.draw, "only this one of them, from 0 on")->check(CLI::Range(0, 999999));
  verb->add_option("--cfl", a->options.cfl,
                   "of all random scenes, beyond what scenes may ask for too, instead of the drawn ones")
      ->check(CLI::Range(0.01, 10.0));
  add_threads(*verb, a->threads);
  verb->callback([a, &action] { action = [a] { return run_cases(*a); }; });
}

}  // namespace dreampm::cli
