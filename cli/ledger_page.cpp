// The columns of the ledger, a table for each group.
#include <fmt/format.h>

#include "dreampm/io/ledger_columns.h"
#include "schema.h"

namespace dreampm::cli {
namespace {

struct GroupText {
  LedgerGroup group;
  const char* head;
};
constexpr GroupText group_texts[] = {{LedgerGroup::steps, "**Frame and steps**"},
                                     {LedgerGroup::mass, "**Mass**"},
                                     {LedgerGroup::momentum, "**Momentum**"},
                                     {LedgerGroup::energy, "**Energy**"},
                                     {LedgerGroup::losses, "`dissipated` is the sum of these:"},
                                     {LedgerGroup::volume, "**Volume**"}};

std::string names_of(const LedgerColumn& column) {
  if (!std::holds_alternative<Vec3d LedgerRow::*>(column.value)) return fmt::format("`{}`", column.name);
  return fmt::format("`{}_x` `_y` `_z`", column.name);
}

std::string meaning_of(const LedgerColumn& column) {
  std::string text(column.meaning);
  if (column.runs == LedgerRuns::with_emitters) text += " Only in runs with emitters.";
  if (column.runs == LedgerRuns::by_projection) text += " Only in runs by the projection.";
  return text;
}

}  // namespace

std::string ledger_page() {
  std::string page =
      "## Columns\n\nPrinted by `dreampm schema --ledger`. Columns of some runs alone stand at the end of a row.\n";
  for (const auto& [group, head] : group_texts) {
    page += fmt::format("\n{}\n\n| column | unit | meaning |\n|---|---|---|\n", head);
    for (const LedgerColumn& c : ledger_columns)
      if (c.group == group) page += fmt::format("| {} | {} | {} |\n", names_of(c), c.unit, meaning_of(c));
  }
  return page;
}

}  // namespace dreampm::cli
