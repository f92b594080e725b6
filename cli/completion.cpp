// `dreampm completion`: what a shell reads to complete the command line.
#include "describe.h"
#include "verbs.h"

namespace dreampm::cli {
namespace {

std::string joined(const std::vector<std::string>& words, const char* between = " ") {
  return fmt::format("{}", fmt::join(words, between));
}

std::vector<std::string> names_of(const std::vector<VerbFacts>& verbs) {
  std::vector<std::string> names;
  for (const VerbFacts& v : verbs) names.push_back(v.path.back());
  return names;
}

std::vector<std::string> names_of(const std::vector<OptionFacts>& options) {
  std::vector<std::string> names;
  for (const OptionFacts& o : options) names.insert(names.end(), o.names.begin(), o.names.end());
  return names;
}

/// The values that may stand where a word without an option stands.
std::vector<std::string> choices_of(const std::vector<OptionFacts>& words) {
  std::vector<std::string> choices;
  for (const OptionFacts& w : words) choices.insert(choices.end(), w.choices.begin(), w.choices.end());
  return choices;
}

/// `text` with a backslash before each of `special`.
std::string escaped(const std::string& text, std::string_view special) {
  std::string out;
  for (const char c : text) {
    if (special.find(c) != special.npos) out += '\\';
    out += c;
  }
  return out;
}

/// Returns the text in single quotes, as bash and zsh read it.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) c == '\'' ? out += "'\\''" : out += c;
  return out + "'";
}

/// "_dreampm_bench_step"
std::string zsh_function(const VerbFacts& v) { return v.path.empty() ? "_dreampm" : "_dreampm_" + joined(v.path, "_"); }

/// The option whose values are in the scene that the line names.
constexpr const char* variant = "--variant";

std::string zsh_value(const OptionFacts& o) {
  const std::string what = o.names.back() == variant ? "_dreampm_variants"
                           : o.choices.empty()       ? "_files"
                                                     : "(" + joined(o.choices) + ")";
  return fmt::format(":{}:{}", o.names.back(), what);
}

std::string zsh_verb(const VerbFacts& v) {
  std::string text = zsh_function(v) + "() {\n";
  if (!v.verbs.empty()) text += "  local context state line\n  typeset -A opt_args\n";
  text += "  _arguments -S";
  for (const OptionFacts& o : v.options)
    for (const std::string& name : o.names)
      text += " \\\n    " + quoted(fmt::format("{}{}[{}]{}", o.repeated ? "*" : "", name, escaped(o.about, "[]:\\"),
                                               o.value.empty() ? "" : zsh_value(o)));
  for (const OptionFacts& w : v.words) text += " \\\n    " + quoted((w.repeated ? "*" : "") + zsh_value(w));
  if (v.verbs.empty()) return text + "\n}\n";
  text += " \\\n    '1: :->verb' '*:: :->rest'\n  case $state in\n    verb)\n      local -a verbs=(\n";
  for (const VerbFacts& sub : v.verbs)
    text += "        " + quoted(sub.path.back() + ":" + escaped(sub.about, ":\\")) + "\n";
  text += "      )\n      _describe verb verbs ;;\n    rest)\n      case $line[1] in\n";
  for (const VerbFacts& sub : v.verbs) text += fmt::format("        {}) {} ;;\n", sub.path.back(), zsh_function(sub));
  return text + "      esac ;;\n  esac\n}\n";
}

/// Returns the text in single quotes, as fish reads it.
std::string fish_quoted(const std::string& text) { return "'" + escaped(text, "\\'") + "'"; }

std::string fish_verb(const VerbFacts& v) {
  const std::string where =
      fmt::format("complete -c dreampm -n {}", fish_quoted("__dreampm_at " + (v.path.empty() ? "''" : joined(v.path))));
  std::string text;
  for (const VerbFacts& sub : v.verbs)
    text += fmt::format("{} -f -a {} -d {}\n", where, sub.path.back(), fish_quoted(sub.about));
  for (const OptionFacts& o : v.options) {
    text += where;
    for (const std::string& name : o.names)
      text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    if (o.names.back() == variant)
      text += " -x -a '(__dreampm_variants)'";
    else if (!o.value.empty())
      text += o.choices.empty() ? " -r" : " -x -a " + fish_quoted(joined(o.choices));
    text += " -d " + fish_quoted(o.about) + "\n";
  }
  if (const auto choices = choices_of(v.words); !choices.empty())
    text += fmt::format("{} -f -a {}\n", where, fish_quoted(joined(choices)));
  return text;
}

}  // namespace

std::string bash_completion(const VerbFacts& top) {
  std::string paths, words, options, values;
  for (const VerbFacts* v : all_verbs(top)) {
    const std::string name = v->name();
    if (!name.empty()) paths += fmt::format("      \"{}\") verb=$next ;;\n", name);
    std::vector<std::string> all = names_of(v->verbs);
    const std::vector<std::string> choices = choices_of(v->words);
    all.insert(all.end(), choices.begin(), choices.end());
    words +=
        fmt::format("    \"{}\") words=\"{}\" options=\"{}\" ;;\n", name, joined(all), joined(names_of(v->options)));
    for (const OptionFacts& o : v->options) {
      if (o.value.empty()) continue;
      for (const std::string& option : o.names)
        values += fmt::format("    \"{} {}\") words=\"{}\" options=\"\" ;;\n", name, option, joined(o.choices));
    }
  }
  return fmt::format(R"(# Completion of dreampm for bash, written by `dreampm completion bash`.
_dreampm() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}} verb="" next="" words="" options="" i
  for ((i = 1; i < COMP_CWORD; ++i)); do
    next="${{verb:+$verb }}${{COMP_WORDS[i]}}"
    case $next in
{}    esac
  done
  case $verb in
{}  esac
  case "$verb $previous" in
{}  esac
  if [[ $previous == --variant ]]; then
    for i in "${{COMP_WORDS[@]:1}}"; do
      [[ $i != *.yaml || ! -f $i ]] || words=$("${{COMP_WORDS[0]}}" completion --variants "$i" 2>/dev/null)
    done
  fi
  [[ $current != -* ]] || words=$options
  # Where none of them fits, bash completes files (-o default), and quotes what their names hold.
  COMPREPLY=($(compgen -W "$words" -- "$current"))
}}
complete -o bashdefault -o default -F _dreampm dreampm
)",
                     paths, words, values);
}

std::string zsh_completion(const VerbFacts& top) {
  std::string text = "#compdef dreampm\n# Completion of dreampm for zsh, written by `dreampm completion zsh`.\n";
  text += R"zsh(_dreampm_variants() {
  local word
  local -a names
  for word in $words; do
    [[ $word == *.yaml && -f $word ]] && names+=(${(f)"$(dreampm completion --variants $word 2>/dev/null)"})
  done
  compadd -a names
}
)zsh";
  for (const VerbFacts* v : all_verbs(top)) text += zsh_verb(*v);
  return text + R"(if [ "$funcstack[1]" = _dreampm ]; then _dreampm "$@"; else compdef _dreampm dreampm; fi
)";
}

std::string fish_completion(const VerbFacts& top) {
  std::string text = R"(# Completion of dreampm for fish, written by `dreampm completion fish`.
# Whether the words typed so far begin with these verbs and no further verb.
function __dreampm_at
    set -l typed (string match -v -- '-*' (commandline -opc))[2..-1]
    set -l verb
    while set -q typed[1]; and contains -- (string join ' ' $verb $typed[1]) $__dreampm_verbs
        set -a verb $typed[1]
        set -e typed[1]
    end
    test "$verb" = "$argv"
end
# The variants of the scene that the line names.
function __dreampm_variants
    for word in (commandline -opc)
        string match -q -- '*.yaml' $word; and test -f $word; and dreampm completion --variants $word 2>/dev/null
    end
end
set -g __dreampm_verbs)";
  for (const VerbFacts* v : all_verbs(top))
    if (!v->path.empty()) text += " " + fish_quoted(v->name());
  text += "\n";
  for (const VerbFacts* v : all_verbs(top)) text += fish_verb(*v);
  return text;
}

namespace {

/// Returns the facts of the verbs, with the names of cases, which the parser leaves to a better
/// message.
VerbFacts described(const CLI::App& app) {
  VerbFacts top = describe(app);
  for (VerbFacts& verb : top.verbs)
    for (OptionFacts& word : verb.words)
      if (word.names.back() == "CASE")
        for (const validate::Case* c : validate::all_cases()) word.choices.emplace_back(c->name);
  return top;
}

}  // namespace

void add_completion(CLI::App& app, Action& action) {
  struct Arguments {
    std::string shell, scene;
  };
  const auto a = std::make_shared<Arguments>();
  CLI::App* verb = add_verb(app, "completion", "Print the script by which a shell completes verbs and options",
                            "dreampm completion bash > ~/.local/share/bash-completion/completions/dreampm");
  CLI::Option* shell = verb->add_option("SHELL", a->shell, "bash, zsh or fish")
                           ->check(CLI::IsMember(std::vector<std::string>{"bash", "zsh", "fish"}));
  verb->add_option("--variants", a->scene, "instead: the variants of a scene file, as these scripts ask for them")
      ->excludes(shell);
  verb->callback([&app, &action, a] {
    action = [&app, a] {
      if (!a->scene.empty()) {
        for (const std::string& name : scene::parse_scene(a->scene, {}).variants) fmt::print("{}\n", name);
        return 0;
      }
      if (a->shell.empty()) fail_input("completion: name a shell: bash, zsh or fish");
      const VerbFacts top = described(app);
      fmt::print("{}", a->shell == "bash"  ? bash_completion(top)
                       : a->shell == "zsh" ? zsh_completion(top)
                                           : fish_completion(top));
      return 0;
    };
  });
}

}  // namespace dreampm::cli
