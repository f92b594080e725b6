#include "validate/report.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <nlohmann/json.hpp>

#include "dreampm/base/file.h"
#include "dreampm/base/parallel.h"
#include "dreampm/io/run_record.h"
#include "dreampm/version.h"
#include "validate/plot.h"

namespace dreampm::validate {
namespace {
using Json = nlohmann::ordered_json;

double cpu_seconds(Clock clock) {
  timespec t{};
  clock_gettime(clock == Clock::thread ? CLOCK_THREAD_CPUTIME_ID : CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

std::string with_unit(double v, const std::string& unit) {
  return unit == "%" ? fmt::format("{:.3g} %", 100 * v) : fmt::format("{:.4g}{}{}", v, unit.empty() ? "" : " ", unit);
}

std::string gate_text(const Metric& m) {
  if (m.side == Metric::Side::none) return "";
  return fmt::format("{} {}", m.side == Metric::Side::at_most ? "<=" : ">=", with_unit(m.gate, m.unit));
}

/// Returns the bound that a control must pass where its gate is not enough.
std::string bound_text(const Control& c) {
  if (!c.beyond) return "";
  return fmt::format("{} {}", c.side == Metric::Side::at_most ? ">" : "<", with_unit(*c.beyond, c.unit));
}

std::string verdict(const Metric& m, const Result& r) {
  if (m.side == Metric::Side::none) return "";
  return std::string(m.pass()         ? "ok"
                     : m.known_miss() ? "MISS, known"
                                      : "MISS") +
         (r.controlled(m) ? "" : ", NO CONTROL");
}

/// A line of a case's set-up.
std::string line_of(const SetUp& s) { return s.scene.empty() ? s.text : s.scene + ": " + s.text; }

/// JSON has no NaN.
Json number(double v) { return std::isfinite(v) ? Json(v) : Json(nullptr); }

std::string cost_text(const Result& r) {
  return fmt::format("{:.1f} s, {:.1f} CPU-s, {:.3g} M particle-steps", r.seconds, r.cpu_seconds,
                     static_cast<double>(r.particle_steps) * 1e-6);
}

/// Returns the faults of a result, a line each behind `indent`.
std::string missed_by(const Result& r, std::string_view indent) {
  std::string missed;
  for (const Metric& m : r.metrics)
    if (!m.pass())
      missed += fmt::format("{}missed{}: {}: {} is {}, wanted {}\n", indent, m.known_miss() ? ", known" : "",
                            r.which->name, m.name, with_unit(m.value, m.unit), gate_text(m));
  for (const Metric& m : r.metrics)
    if (r.error.empty() && !r.controlled(m))
      missed += fmt::format("{}without a control: {}: {}\n", indent, r.which->name, m.name);
  for (const Control& c : r.controls)
    if (!c.fails) missed += fmt::format("{}not caught: {}: {}: {}\n", indent, r.which->name, c.metric, c.what);
  for (const Attachment& a : r.attachments) missed += fmt::format("{}{}: {}\n", indent, a.name, a.about);
  if (!r.error.empty()) missed += fmt::format("{}failed: {}: {}\n", indent, r.which->name, r.error);
  return missed;
}

}  // namespace

bool Result::passed() const {
  return sound() && std::all_of(metrics.begin(), metrics.end(), [](const Metric& m) { return m.pass(); });
}

bool Result::known() const {
  return !passed() && sound() &&
         std::all_of(metrics.begin(), metrics.end(), [](const Metric& m) { return m.pass() || m.known_miss(); });
}

bool Result::controlled(const Metric& metric) const {
  return metric.side == Metric::Side::none ||
         std::any_of(controls.begin(), controls.end(), [&](const Control& c) { return c.metric == metric.name; });
}

bool Result::sound() const {
  return error.empty() && !metrics.empty() &&
         std::all_of(metrics.begin(), metrics.end(), [&](const Metric& m) { return controlled(m); }) &&
         std::all_of(controls.begin(), controls.end(), [](const Control& c) { return c.fails; });
}

Result run_case(const Case& which, const Options& options, const std::filesystem::path& folder, Clock clock) {
  Trial trial(options);
  Result r;
  r.which = &which;
  r.options = options;
  const auto start = std::chrono::steady_clock::now();
  const double cpu = cpu_seconds(clock);
  try {
    which.run(trial);
  } catch (const Interrupted&) {
    throw;
  } catch (const Error& e) {
    r.error = e.what();
  }
  r.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  r.cpu_seconds = cpu_seconds(clock) - cpu;
  r.particle_steps = trial.particle_steps;
  r.metrics = std::move(trial.metrics);
  r.controls = std::move(trial.controls);
  r.set_ups = std::move(trial.set_ups);
  for (const Plot& p : trial.plots) r.plots.push_back(write_plot(p, folder));
  r.attachments = std::move(trial.attachments);
  for (Attachment& a : r.attachments) {
    a.name = (folder / a.name).string();
    replace_file_text(a.name, a.text);
  }
  return r;
}

std::vector<const Case*> cases_of(Level level) {
  std::vector<const Case*> some;
  for (const Case* c : all_cases())
    if (c->quick || level == Level::full) some.push_back(c);
  return some;
}

std::string text_of(const Result& r) {
  std::string s = fmt::format("{}: {}\n", r.which->name, r.which->about);
  for (const SetUp& up : r.set_ups) s += fmt::format("  set-up: {}\n", line_of(up));
  for (const Metric& m : r.metrics) {
    s += fmt::format("  {:<58}{:>14}{:>14}  {}\n", m.name, with_unit(m.value, m.unit), gate_text(m), verdict(m, r));
    if (!m.pass() && !m.diagnosis.empty())
      s += fmt::format("    known, up to {}: {}\n", with_unit(m.known_to, m.unit), m.diagnosis);
  }
  for (const Control& c : r.controls)
    s += fmt::format("  {:<58}{:>14}{:>14}  {}\n", fmt::format("control: {}", c.what), with_unit(c.value, c.unit),
                     bound_text(c), c.fails ? "caught" : "NOT CAUGHT");
  for (const Attachment& a : r.attachments) s += fmt::format("  {}: {}\n{}", a.name, a.about, a.text);
  if (!r.error.empty()) s += fmt::format("  the run failed: {}\n", r.error);
  return s + fmt::format("  {}\n", cost_text(r));
}

std::string summary_of(const std::vector<Result>& results, double seconds) {
  std::string missed;
  std::size_t passed = 0, known = 0;
  double cpu = 0;
  for (const Result& r : results) {
    passed += r.passed(), known += r.known();
    cpu += r.cpu_seconds;
    missed += missed_by(r, "  ");
  }
  return fmt::format(
      "{} of {} cases passed, {} missed only gates that they are known to miss, {} failed; {:.0f} s "
      "({:.0f} CPU-s)\n{}",
      passed, results.size(), known, results.size() - passed - known, seconds, cpu, missed);
}

bool succeeded(const std::vector<Result>& results) {
  return std::all_of(results.begin(), results.end(), [](const Result& r) { return r.passed() || r.known(); });
}

std::string json_of(const std::vector<Result>& results) {
  Json cases = Json::array();
  int passed = 0, failed = 0, known = 0;
  for (const Result& r : results) {
    Json metrics = Json::array();
    for (const Metric& m : r.metrics) {
      Json one{{"name", m.name}, {"unit", m.unit == "%" ? "1" : m.unit}, {"value", number(m.value)}};
      const bool judged = m.side != Metric::Side::none;
      one["gate"] = judged ? Json(m.gate) : Json(nullptr);
      if (judged) one["side"] = m.side == Metric::Side::at_most ? "at_most" : "at_least";
      if (judged) one["controlled"] = r.controlled(m);
      one["pass"] = m.pass();
      if (!m.diagnosis.empty()) one["diagnosis"] = m.diagnosis;
      if (!m.pass()) one["known"] = m.known_miss();
      metrics.push_back(one);
    }
    Json set_up = Json::array();
    for (const SetUp& up : r.set_ups) set_up.push_back(line_of(up));
    Json one{{"name", std::string(r.which->name)}, {"set_up", set_up}, {"metrics", metrics}};
    Json controls = Json::array();
    for (const Control& c : r.controls) {
      Json one_control{{"what", c.what}, {"metric", c.metric}, {"value", number(c.value)}, {"gate", c.gate}};
      if (c.beyond) one_control["beyond"] = *c.beyond;
      one_control["fails"] = c.fails;
      controls.push_back(one_control);
    }
    // FORMATS names one control a case; more than one come in a list beside it.
    if (!controls.empty()) one["control"] = controls[0];
    if (controls.size() > 1) one["controls"] = controls;
    one["seconds"] = r.seconds;
    one["cpu_seconds"] = r.cpu_seconds;
    one["particle_steps"] = r.particle_steps;
    if (!r.plots.empty()) one["plot"] = r.plots[0].string();
    if (r.plots.size() > 1) {
      one["plots"] = Json::array();
      for (const auto& p : r.plots) one["plots"].push_back(p.string());
    }
    for (const Attachment& a : r.attachments) one["attachments"].push_back({{"file", a.name}, {"about", a.about}});
    if (!r.options.backend.empty()) one["backend"] = r.options.backend;
    if (!r.error.empty()) one["error"] = r.error;
    one["pass"] = r.passed();
    (r.passed() ? passed : failed)++;
    known += r.known();
    cases.push_back(one);
  }
  return Json{{"dreampm", version}, {"commit", commit}, {"cases", cases},
              {"passed", passed},   {"failed", failed}, {"known", known}}
      .dump(2);
}

std::string section_of(const Result& r, const std::string& plots) {
  const std::string_view how = r.passed() ? "passed" : r.known() ? "missed as known" : "FAILED";
  std::string s = fmt::format("## {}\n\n{}\n\nReference: {}.\n\n{}{} at {} resolution by {}, commit {}, on {}{}.\n\n",
                              r.which->name, r.which->about, r.which->source, result_mark, how,
                              r.options.level == Level::full ? "full" : "quick", version, commit,
                              this_machine("auto", thread_count()).cpu,
                              r.options.backend.empty() ? "" : fmt::format(", --backend {}", r.options.backend));
  const std::string missed = missed_by(r, "- ");
  if (!missed.empty()) s += missed + "\n";
  for (const SetUp& up : r.set_ups)
    s += up.scene.empty() ? fmt::format("- {}\n", up.text)
                          : fmt::format("- [{0}](../scenes/validation/{0}.yaml): {1}\n", up.scene, up.text);
  s += fmt::format("{}| metric | value | gate | |\n|---|---|---|---|\n", r.set_ups.empty() ? "" : "\n");
  for (const Metric& m : r.metrics)
    s += fmt::format("| {} | {} | {} | {} |\n", m.name, with_unit(m.value, m.unit), gate_text(m), verdict(m, r));
  for (const Control& c : r.controls)
    s += fmt::format("| control: {} ({}) | {} | {} | {} |\n", c.what, c.metric, with_unit(c.value, c.unit),
                     bound_text(c), c.fails ? "caught" : "NOT CAUGHT");
  s += "\n";
  for (const Metric& m : r.metrics)
    if (!m.pass() && !m.diagnosis.empty()) s += fmt::format("Missed, {}: {}\n\n", m.name, m.diagnosis);
  s += fmt::format("Cost: {}.\n\n", cost_text(r));
  for (const auto& p : r.plots) s += fmt::format("![{}]({}/{})\n\n", r.which->name, plots, p.filename().string());
  s.pop_back();
  return s;
}

}  // namespace dreampm::validate
