#include "describe.h"

#include <sstream>

#include "verbs.h"

namespace dreampm::cli {
namespace {

/// CLI11 puts the words of IsMember behind the type: TEXT:{jitter,lattice}.
std::vector<std::string> choices_in(const std::string& type) {
  std::vector<std::string> choices;
  const std::size_t open = type.find(":{"), close = type.rfind('}');
  if (open == type.npos || close == type.npos) return choices;
  std::istringstream words(type.substr(open + 2, close - open - 2));
  for (std::string word; std::getline(words, word, ',');) choices.push_back(word);
  return choices;
}

/// Returns the name of a type that CLI11 calls TEXT, FLOAT, INT, UINT.
std::string value_text(const std::string& type) {
  return type.starts_with("TEXT") ? "TEXT" : type.starts_with("FLOAT") ? "NUMBER" : "N";
}

/// CLI11 puts it behind the type: FLOAT:in [0 - 1].
std::string range_in(const std::string& type) {
  const std::size_t colon = type.find(':');
  return colon == type.npos || type.find('{') != type.npos ? "" : type.substr(colon + 1);
}

/// The lines that are indented after "Example:" in a footer.
std::string example_in(const std::string& footer) {
  constexpr std::string_view head = "Example:\n";
  const std::size_t at = footer.find(head);
  if (at == footer.npos) return {};
  std::istringstream lines(footer.substr(at + head.size()));
  std::string example;
  for (std::string line; std::getline(lines, line) && line.starts_with("  ");)
    example += (example.empty() ? "" : "\n") + line.substr(2);
  return example;
}

OptionFacts facts_of(const CLI::Option& o) {
  OptionFacts facts;
  if (o.get_positional()) facts.names.push_back(o.get_name(true));
  for (const std::string& n : o.get_snames()) facts.names.push_back("-" + n);
  for (const std::string& n : o.get_lnames()) facts.names.push_back("--" + n);
  facts.about = o.get_description();
  if (o.get_items_expected_max() > 0) {
    facts.value = value_text(o.get_type_name());
    facts.range = range_in(o.get_type_name());
    facts.choices = choices_in(o.get_type_name());
    facts.fallback = o.get_default_str();
  }
  facts.required = o.get_required();
  facts.repeated = o.get_expected_max() >= CLI::detail::expected_max_vector_size;
  return facts;
}

VerbFacts facts_of(const CLI::App& app, std::vector<std::string> path) {
  VerbFacts facts;
  facts.about = app.get_description();
  facts.example = example_in(app.get_footer());
  for (const CLI::Option* o : app.get_options()) {
    OptionFacts one = facts_of(*o);
    (o->get_positional() ? facts.words : facts.options).push_back(std::move(one));
  }
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; })) {
    path.push_back(verb->get_name());
    facts.verbs.push_back(facts_of(*verb, path));
    path.pop_back();
  }
  facts.path = std::move(path);
  return facts;
}

}  // namespace

std::string VerbFacts::name() const { return fmt::format("{}", fmt::join(path, " ")); }

VerbFacts describe(const CLI::App& app) { return facts_of(app, {}); }

std::vector<const VerbFacts*> all_verbs(const VerbFacts& top) {
  std::vector<const VerbFacts*> all{&top};
  for (const VerbFacts& verb : top.verbs)
    for (const VerbFacts* one : all_verbs(verb)) all.push_back(one);
  return all;
}

}  // namespace dreampm::cli
