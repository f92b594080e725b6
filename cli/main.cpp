// dreampm: verbs, errors and exit codes. 0 done, 1 the run failed, 2 bad input or usage, 130
// interrupted.
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <new>

#include "verbs.h"

namespace dreampm::cli {
namespace {

int complain(const std::string& text, int code) {
  // Errors in a scene come with their own file:line:col: error:.
  const bool placed = text.find(": error: ") != std::string::npos;
  std::cerr << (placed ? "" : "error: ") << text << "\n";
  return code;
}

/// Returns the words before the first option: verbs, and their arguments.
std::vector<std::string> leading_words(int argc, char** argv) {
  return {argv + 1, std::find_if(argv + 1, argv + argc, [](const char* word) { return word[0] == '-'; })};
}

/// Returns the message for words that were not understood; an option gets the nearest one of its
/// verb.
std::string extras_text(const CLI::App& app, const CLI::ExtrasError& e) {
  const CLI::App* verb = &app;
  while (!verb->get_subcommands().empty()) verb = verb->get_subcommands().front();
  for (std::string extra : app.remaining(true)) {
    if (!extra.starts_with("--")) continue;
    extra = extra.substr(0, extra.find('='));
    std::vector<std::string> names;
    for (const CLI::Option* o : verb->get_options())
      for (const std::string& name : o->get_lnames()) names.push_back("--" + name);
    return fmt::format("{} has no option '{}'{}", verb->get_name(), extra, scene::suggest(extra, names));
  }
  return e.what();
}

/// Returns the message for a line without a verb; nothing where there is one.
std::string without_verb(const CLI::App& app, int argc, char** argv) {
  if (argc < 2) return "no verb; dreampm --help lists them";
  const std::string first = argv[1];
  if (first == "version") return "no verb 'version': dreampm --version prints it";
  if (!first.starts_with("-")) return {};
  std::vector<std::string> names;
  for (const CLI::Option* o : app.get_options()) {
    for (const std::string& name : o->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : o->get_snames()) names.push_back("-" + name);
  }
  if (std::find(names.begin(), names.end(), first) != names.end()) return {};
  return fmt::format("dreampm has no option '{}' before a verb{}", first, scene::suggest(first, names));
}

int run(int argc, char** argv) {
  catch_interrupts();
  std::signal(SIGXFSZ, SIG_IGN);  // a file too large is an error of the write, reported like a full disk
  CLI::App app{"DreaMPM: scenes of moving matter, from a scene file to a film", "dreampm"};
  app.set_version_flag("--version", fmt::format("dreampm {} ({})", version, commit));
  app.footer("\nExample:\n  dreampm make scenes/dam-break.yaml\n\n'dreampm VERB --help' says more about a verb.");
  app.require_subcommand(1);
  Action action;
#define DM_ADD(name) add_##name(app, action);
  DM_VERBS(DM_ADD)
#undef DM_ADD

  if (const std::string wrong = without_verb(app, argc, argv); !wrong.empty()) return complain(wrong, 2);
  const std::vector<std::string> words = leading_words(argc, argv);
  try {
    // CLI11 would name a word that is no verb, but not the nearest verb.
    std::span<const std::string> rest = words;
    find_verb(app, rest);
    app.parse(argc, argv);
  } catch (const InputError& e) {
    return complain(e.what(), e.exit_code());
  } catch (const CLI::Success& e) {  // --help, --version
    return app.exit(e);
  } catch (const CLI::ExtrasError& e) {
    return complain(extras_text(app, e), 2);
  } catch (const CLI::ParseError& e) {
    return complain(e.what(), 2);
  }
  try {
    return action();
  } catch (const Interrupted& e) {
    std::cerr << e.what() << "\n";
    return e.exit_code();
  } catch (const Error& e) {
    return complain(e.what(), e.exit_code());
  } catch (const std::bad_alloc&) {
    return complain("out of memory: a larger spacing or a smaller picture needs less", 1);
  } catch (const std::exception& e) {
    return complain(std::string("a fault of the program: ") + e.what(), 1);
  }
}

}  // namespace
}  // namespace dreampm::cli

int main(int argc, char** argv) { return dreampm::cli::run(argc, argv); }
