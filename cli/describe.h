// The command line as data: what the man page, the page in docs/reference and the
// completion of shells are written from.
#pragma once
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace dreampm::cli {

/// An option, or a word that stands without one.
struct OptionFacts {
  std::vector<std::string> names;    ///< "-h", "--help"; of a word its own: "SCENE"
  std::string about;                 ///< one sentence, without a full stop
  std::string value;                 ///< what follows: TEXT, NUMBER, N; empty for a flag
  std::string range;                 ///< of numbers: "in [0 - 1]"; empty: any
  std::string fallback;              ///< the default, if it is known
  std::vector<std::string> choices;  ///< the only values; empty: any
  bool required = false, repeated = false;
};

/// A verb, or the command itself.
struct VerbFacts {
  std::vector<std::string> path;  ///< {"bench", "step"}; empty: the command itself
  std::string about, example;
  std::vector<OptionFacts> options, words;
  std::vector<VerbFacts> verbs;

  /// "bench step"
  std::string name() const;
};

VerbFacts describe(const CLI::App& app);

/// It and all below it.
std::vector<const VerbFacts*> all_verbs(const VerbFacts& top);

/// Scripts that complete verbs, options and their values.
std::string bash_completion(const VerbFacts& top);
std::string zsh_completion(const VerbFacts& top);
std::string fish_completion(const VerbFacts& top);
/// The man page, in section 1.
std::string man_page(const VerbFacts& top);

}  // namespace dreampm::cli
