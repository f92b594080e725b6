// `dreampm help`: the help of a verb, and the page of all of them.
#include <algorithm>

#include "verbs.h"

namespace dreampm::cli {
namespace {

std::vector<const CLI::App*> verbs_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* verb) { return !verb->get_name().empty(); });
}

/// "--frames N", "SCENE": as it is typed.
std::string typed_text(const CLI::Option& o) {
  if (o.get_positional()) return "`" + o.get_name(true) + "`";
  std::string text = "`" + o.get_name(false, true);
  const std::string type = o.get_type_name().substr(0, o.get_type_name().find(':'));
  if (o.get_items_expected_max() > 0)
    text += type.starts_with("TEXT") ? " TEXT" : type.starts_with("FLOAT") ? " NUMBER" : " N";
  return text + "`";
}

/// Its limits, in the words of the check: "in [1 - 4096]". Lists of words stand in descriptions.
std::string limits_text(const CLI::Option& o) {
  const std::string type = o.get_type_name();
  const std::size_t colon = type.find(':');
  if (colon == std::string::npos || type.find('{') != std::string::npos) return "";
  return fmt::format("; {}", type.substr(colon + 1));
}

std::string option_row(const CLI::Option& o) {
  std::string text = fmt::format("| {} | {}", typed_text(o), o.get_description());
  text += limits_text(o);
  if (!o.get_default_str().empty()) text += fmt::format("; default `{}`", o.get_default_str());
  if (o.get_required()) text += "; **required**";
  return text + " |\n";
}

std::string options_table(const CLI::App& verb) {
  std::string rows;
  for (const bool positional : {true, false})
    for (const CLI::Option* o : verb.get_options())
      if (o != verb.get_help_ptr() && o->get_positional() == positional) rows += option_row(*o);
  return rows.empty() ? "" : "\n| option | meaning |\n|---|---|\n" + rows;
}

/// The lines after "Example:" at the end of a verb's help.
std::string example_of(const CLI::App& verb) {
  constexpr std::string_view head = "Example:\n  ";
  const std::string foot = verb.get_footer();
  const std::size_t at = foot.find(head);
  if (at == std::string::npos) return "";
  return "\n```sh\n" + foot.substr(at + head.size()) + "\n```\n";
}

std::string verb_text(const CLI::App& verb, const std::string& before) {
  const std::string name = before + verb.get_name();
  std::string text = fmt::format("\n## {}\n\n{}.\n", name, verb.get_description());
  text += example_of(verb) + options_table(verb);
  for (const CLI::App* own : verbs_of(verb)) text += verb_text(*own, name + " ");
  return text;
}

constexpr const char* page_head = R"(# The command line

Made by `dreampm help --markdown` from what the command reads; a test compares both. `dreampm VERB
--help` and `dreampm help VERB` print the same about one verb.

Exit codes: 0 done, 1 the run failed, 2 wrong input, 130 interrupted.
)";

std::string page_of(const CLI::App& app) {
  std::string page = page_head;
  for (const CLI::App* verb : verbs_of(app)) page += verb_text(*verb, "");
  return page;
}

/// The help of the verb that the words name; nothing: of the command.
std::string help_of(const CLI::App& app, const std::vector<std::string>& words) {
  const CLI::App* verb = &app;
  std::string typed = app.get_name();
  for (const std::string& word : words) {
    std::vector<std::string> names;
    const CLI::App* next = nullptr;
    for (const CLI::App* one : verbs_of(*verb)) {
      names.push_back(one->get_name());
      if (one->get_name() == word) next = one;
    }
    if (!next) fail_input("no verb '{}'{}", word, scene::suggest(word, names));
    typed += " " + word;
    verb = next;
  }
  // App::help would go on to the verb that was typed, which is this one.
  return app.get_formatter()->make_help(verb, typed, CLI::AppFormatMode::Normal);
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
