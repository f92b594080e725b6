// `dreampm manual`: the man page, from what the command line is made of.
#include "describe.h"
#include "dreampm/scene/value_info.h"
#include "verbs.h"

namespace dreampm::cli {
namespace {

/// Returns the text for roff: a hyphen that can be copied, and no line that begins like a request.
std::string roff(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if ((c == '.' || c == '\'') && (out.empty() || out.back() == '\n')) out += "\\&";
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
  }
  return out;
}

std::string option_text(const OptionFacts& o) {
  std::string head;
  for (const std::string& name : o.names) head += (head.empty() ? "\\fB" : ", \\fB") + roff(name) + "\\fR";
  if (!o.value.empty() && o.names[0].starts_with("-"))
    head += " \\fI" + roff(o.value + (o.range.empty() ? "" : " " + o.range)) + "\\fR";
  std::string text = ".TP\n" + head + "\n" + roff(scene::sentence(o.about));
  if (!o.fallback.empty()) text += roff(" Default: " + o.fallback + ".");
  return text + "\n";
}

std::string synopsis(const VerbFacts& v) {
  std::string text = ".B dreampm";
  if (!v.path.empty()) text += " " + roff(v.name());
  text += "\n";
  if (!v.options.empty()) text += "[\\fIOPTIONS\\fR]\n";
  for (const OptionFacts& w : v.words)
    text += fmt::format("{}\\fI{}\\fR{}{}\n", w.required ? "" : "[", roff(w.names[0]), w.repeated ? "..." : "",
                        w.required ? "" : "]");
  if (!v.verbs.empty()) text += "\\fIVERB\\fR ...\n";
  return text;
}

std::string verb_text(const VerbFacts& v) {
  std::string text =
      ".SS dreampm " + roff(v.name()) + "\n" + synopsis(v) + ".PP\n" + roff(scene::sentence(v.about)) + "\n";
  for (const auto* group : {&v.words, &v.options})
    for (const OptionFacts& o : *group)
      if (o.names.back() != "--help") text += option_text(o);
  if (!v.example.empty()) text += ".PP\nExample:\n.PP\n.RS\n.nf\n" + roff(v.example) + "\n.fi\n.RE\n";
  return text;
}

constexpr const char* end_text = R"(.SH EXIT STATUS
.TP
.B 0
Done.
.TP
.B 1
The run failed, or a gate of \fBvalidate\fR was missed.
.TP
.B 2
The input or the command line was wrong; the message names the file, the place and what would be right.
.TP
.B 130
Interrupted. What was written is whole, and the same command goes on from there.
.SH ENVIRONMENT
.TP
.B DREAMPM_CACHE
Where downloaded models lie. Default: \fI$XDG_CACHE_HOME/dreampm\fR, else \fI~/.cache/dreampm\fR.
.TP
.B DREAMPM_FFMPEG
The program that encodes films. Default: the libraries of FFmpeg that the command was built with, else \fIffmpeg\fR on the PATH.
.SH FILES
.TP
.I out/NAME
What a run of the scene NAME writes, below the working folder.
.TP
.I PREFIX/share/dreampm/scenes
Scenes to begin with, where the command is installed.
)";

}  // namespace

std::string man_page(const VerbFacts& top) {
  std::string text = fmt::format(".TH DREAMPM 1 \"\" \"dreampm {}\" \"User Commands\"\n", version);
  text += ".SH NAME\ndreampm \\- simulate liquids and solids by the material point method, from a scene to a film\n";
  text +=
      ".SH SYNOPSIS\n.B dreampm\n\\fIVERB\\fR\n[\\fIOPTIONS\\fR] ...\n.br\n.B "
      "dreampm\n\\fIVERB\\fR\n\\fB\\-\\-help\\fR\n";
  text +=
      ".SH DESCRIPTION\nA scene is described in one text file. One command turns it into a film: it simulates,\n"
      "wraps a surface around liquids, renders the frames and encodes them. Each stage is a verb of its own,\n"
      "and an interrupted one goes on where it stopped.\n.SH OPTIONS\n";
  for (const OptionFacts& o : top.options) text += option_text(o);
  text += ".SH VERBS\n";
  for (const VerbFacts* v : all_verbs(top))
    if (!v->path.empty()) text += verb_text(*v);
  return text + end_text;
}

void add_manual(CLI::App& app, Action& action) {
  CLI::App* verb =
      add_verb(app, "manual", "Print the man page, with every verb and option", "dreampm manual | man -l -");
  verb->callback([&app, &action] {
    action = [&app] {
      fmt::print("{}", man_page(describe(app)));
      return 0;
    };
  });
}

}  // namespace dreampm::cli
