#include <algorithm>
#include <chrono>

#include "verbs.h"

namespace dreampm::cli {
namespace {

struct ValidateArguments {
  std::vector<std::string> cases;
  std::string out = "out/validation", markdown;
  int threads = 0;
  validate::Options options;
  bool quick = false, full = false, json = false, list = false;
  std::vector<std::string> of_stability;  ///< the options given that only this case reads
};

void print_list() {
  for (const validate::Case* c : validate::all_cases())
    fmt::print("{:<26}{}{}\n", c->name, c->about, c->quick ? "" : " (only with --full)");
}

/// The named cases in the order given, or all of the level. A case asked for by name runs at either
/// level.
std::vector<const validate::Case*> wanted(const ValidateArguments& a, validate::Level level) {
  std::vector<const validate::Case*> some;
  if (a.cases.empty() || (a.cases.size() == 1 && a.cases[0] == "all")) {
    some = validate::cases_of(level);
  } else {
    for (const std::string& name : a.cases) {
      if (name == "all") fail_input("'all' stands alone: it names every case; leave it out or the other names");
      const validate::Case* c = &validate::find_case(name);
      // Both would write the same files, perhaps at once.
      if (std::find(some.begin(), some.end(), c) != some.end()) fail_input("case '{}' is named twice", name);
      some.push_back(c);
    }
  }
  if (!a.of_stability.empty() &&
      std::none_of(some.begin(), some.end(), [](const validate::Case* c) { return c->name.starts_with("stability"); }))
    fail_input("{} is of the case stability, which is not among those asked for; name it too, or leave {} out",
               a.of_stability[0], a.of_stability[0]);
  return some;
}

int run_cases(const ValidateArguments& a) {
  if (a.list) return print_list(), 0;
  validate::Options options = a.options;
  options.level = a.full ? validate::Level::full : validate::Level::quick;
  const ThreadLimit threads(a.threads);
  // Checks that would fail after minutes of computing fail here.
  const auto cases = wanted(a, options.level);
  validate::check_backend(options);
  make_folder(a.out);
  check_replaceable(std::filesystem::path(a.out) / fmt::format("{}.svg", cases[0]->name));
  if (!a.markdown.empty()) check_replaceable(a.markdown);
  const auto start = std::chrono::steady_clock::now();
  const auto results = validate::run_cases(cases, options, a.out, [&](const validate::Result& r) {
    if (!a.json) fmt::print("{}\n", validate::text_of(r));
    std::fflush(stdout);
  });
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (a.json)
    fmt::print("{}\n", validate::json_of(results));
  else if (!results.empty())
    fmt::print("{}", validate::summary_of(results, seconds));
  if (results.size() < cases.size())
    throw Interrupted(fmt::format("interrupted: {} of {} cases were done", results.size(), cases.size()));
  if (!a.markdown.empty()) {
    const std::filesystem::path page(a.markdown);
    const auto folder = std::filesystem::relative(a.out, page.parent_path().empty() ? "." : page.parent_path());
    const std::string before = std::filesystem::exists(page) ? read_file(page) : "";
    replace_file_text(page, validate::page_with(results, folder.generic_string(), before));
  }
  return validate::succeeded(results) ? 0 : 1;
}

}  // namespace

void add_validate(CLI::App& app, Action& action) {
  auto a = std::make_shared<ValidateArguments>();
  CLI::App* verb = add_verb(app, "validate", "Compare the solver with experiments and exact solutions",
                            "dreampm validate still-column bar-wave --out out/validation");
  verb->add_option("CASE", a->cases, "cases by name, or only the word all (--list names them)");
  auto* quick = verb->add_flag("--quick", a->quick, "the set of 5 minutes on 2 cores (default)");
  verb->add_flag("--full", a->full, "every case at full resolution, within 40 minutes")->excludes(quick);
  auto* json = verb->add_flag("--json", a->json, "print JSON");
  verb->add_flag("--list", a->list, "only name the cases")->excludes(json);
  verb->add_option("--out", a->out, "folder for the plots")->capture_default_str();
  verb->add_option("--markdown", a->markdown,
                   "also write the results into this page: cases that were not run stay as they are in it");
  auto* draws = verb->add_option("--draws", a->options.draws,
                                 "of the case stability: how many random scenes (12; 200 with --full)")
                    ->transform(whole_number(1, 1000000));
  auto* seed = verb->add_option("--seed", a->options.seed, "of the random scenes")
                   ->capture_default_str()
                   ->transform(whole_number(0));
  auto* draw = verb->add_option("--draw", a->options.draw, "only this one of them, from 0 on")
                   ->transform(whole_number(0, 999999))
                   ->excludes(draws);
  auto* cfl = verb->add_option("--cfl", a->options.cfl,
                               "of all random scenes, beyond what scenes may ask for too, instead of the drawn ones")
                  ->check(number_in(0.01, 10));
  add_backend(*verb, a->options.backend, "cpu; not one in double, which cases ask for themselves");
  add_threads(*verb, a->threads);
  verb->callback([=, &action] {
    a->of_stability = given({draws, seed, draw, cfl});
    action = [a] { return run_cases(*a); };
  });
}

}  // namespace dreampm::cli
