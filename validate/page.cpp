#include "validate/page.h"

#include <fmt/format.h>

#include <algorithm>

namespace dreampm::validate {
namespace {

struct Section {
  std::string name, text;
  /// Empty: of a page that does not say it.
  std::string result() const {
    const std::size_t at = text.find(fmt::format("\n{}", result_mark));
    if (at == text.npos) return "";
    const std::size_t from = at + 1 + result_mark.size();
    return text.substr(from, text.find(".\n", from) - from);
  }
};

std::vector<Section> sections_of(std::string_view page) {
  constexpr std::string_view head = "\n## ";
  std::vector<Section> all;
  for (std::size_t at = page.find(head); at != page.npos;) {
    const std::size_t next = page.find(head, at + 1), name = at + head.size();
    all.push_back({std::string(page.substr(name, page.find('\n', name) - name)),
                   std::string(page.substr(at + 1, next == page.npos ? next : next - at - 1))});
    while (all.back().text.ends_with("\n\n")) all.back().text.pop_back();
    at = next;
  }
  return all;
}

/// Returns the place of a case in the list; the list's end where it is not there.
std::size_t place_of(const std::string& name) {
  const auto all = all_cases();
  return static_cast<std::size_t>(std::find_if(all.begin(), all.end(), [&](const Case* c) { return c->name == name; }) -
                                  all.begin());
}

}  // namespace

std::string page_with(const std::vector<Result>& results, const std::string& plots, std::string_view before) {
  std::vector<Section> sections;
  for (const Result& r : results) sections.push_back({std::string(r.which->name), section_of(r, plots)});
  for (Section& old : sections_of(before)) {
    const bool is_new =
        std::none_of(sections.begin(), sections.end(), [&](const Section& s) { return s.name == old.name; });
    if (is_new && place_of(old.name) < all_cases().size() && !old.result().empty()) sections.push_back(std::move(old));
  }
  std::stable_sort(sections.begin(), sections.end(),
                   [](const Section& a, const Section& b) { return place_of(a.name) < place_of(b.name); });
  std::string page =
      "# Validation\n\nThis page is written by `dreampm validate --markdown FILE`. The cases that are run take the "
      "place of\n"
      "those that were there, so that it can be made in pieces; each says which version made it.\n"
      "Gates are set by the references and are never moved: a miss stays a miss.\n"
      "[How to add a case](howto/add-a-validation-case.md).\n\n| case | result |\n|---|---|\n";
  for (const Section& s : sections) page += fmt::format("| [{0}](#{0}) | {1} |\n", s.name, s.result());
  for (const Section& s : sections) page += "\n" + s.text;
  return page;
}

}  // namespace dreampm::validate
