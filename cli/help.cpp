// `dreampm help`: the help of a verb, and the page of all of them.
#include <algorithm>

#include "describe.h"
#include "verbs.h"

namespace dreampm::cli {
namespace {

/// Returns the option as it is typed: "--frames N", "SCENE".
std::string typed_text(const OptionFacts& o, bool is_word) {
  return "`" + o.names.back() + (is_word || o.value.empty() ? "" : " " + o.value) + "`";
}

std::string option_row(const OptionFacts& o, bool is_word) {
  std::string text = fmt::format("| {} | {}", typed_text(o, is_word), o.about);
  if (!o.range.empty()) text += "; " + o.range;
  if (!o.fallback.empty()) text += fmt::format("; default `{}`", o.fallback);
  if (o.required) text += "; **required**";
  return text + " |\n";
}

std::string verb_text(const VerbFacts& verb) {
  std::string text = fmt::format("\n## {}\n\n{}.\n", verb.name(), verb.about);
  if (!verb.example.empty()) text += "\n```sh\n" + verb.example + "\n```\n";
  std::string rows;
  for (const OptionFacts& word : verb.words) rows += option_row(word, true);
  for (const OptionFacts& option : verb.options)
    if (option.names.back() != "--help") rows += option_row(option, false);
  return text + (rows.empty() ? "" : "\n| option | meaning |\n|---|---|\n" + rows);
}

constexpr const char* page_head = R"(# The command line

Made by `dreampm help --markdown` from what the command reads; a test compares both. `dreampm VERB
--help` and `dreampm help VERB` print the same about one verb.

Exit codes: 0 done, 1 the run failed, 2 wrong input, 130 interrupted.

Lines have colors on a terminal, unless the variable NO_COLOR is set.
)";

std::string page_of(const CLI::App& app) {
  std::string page = page_head;
  const VerbFacts top = describe(app);
  for (const VerbFacts* verb : all_verbs(top))
    if (!verb->path.empty()) page += verb_text(*verb);
  return page;
}

/// The help of the verb that the words name; nothing: of the command.
std::string help_of(const CLI::App& app, const std::vector<std::string>& words) {
  std::span<const std::string> more = words;
  const CLI::App& verb = find_verb(app, more);
  if (!more.empty()) fail_input("no verb '{}': {} has no verbs of its own", more[0], verb.get_name());
  std::string typed = app.get_name();
  for (const std::string& word : words) typed += " " + word;
  // App::help would go on to the verb that was typed, which is this one.
  return app.get_formatter()->make_help(&verb, typed, CLI::AppFormatMode::Normal);
}

}  // namespace

void add_help(CLI::App& app, Action& action) {
  auto words = std::make_shared<std::vector<std::string>>();
  auto markdown = std::make_shared<bool>(false);
  CLI::App* verb = add_verb(app, "help", "Print the help of a verb, or of the command", "dreampm help run");
  CLI::Option* named = verb->add_option("VERB", *words, "such as run, or bench step");
  verb->add_flag("--markdown", *markdown, "print the page docs/reference/command-line.md")->excludes(named);
  verb->callback([words, markdown, &app, &action] {
    action = [words, markdown, &app] {
      fmt::print("{}", *markdown ? page_of(app) : help_of(app, *words));
      return 0;
    };
  });
}

}  // namespace dreampm::cli
