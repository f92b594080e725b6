#include "dreampm/io/ledger_columns.h"

#include <algorithm>

#include "dreampm/base/error.h"

namespace dreampm {
namespace {

constexpr std::size_t shown_bytes() {
  std::size_t bytes = 0;
  for (const LedgerColumn& c : ledger_columns)
    bytes += std::visit([]<class M>(M LedgerRow::*) { return sizeof(M); }, c.value);
  return bytes;
}
// Each member has a column. `frame` and `limiter` share a place of 8 bytes.
static_assert(shown_bytes() + sizeof(double) - sizeof(int) - sizeof(Limiter) == sizeof(LedgerRow));

bool is_vector(const LedgerColumn& column) { return std::holds_alternative<Vec3d LedgerRow::*>(column.value); }

std::vector<LedgerCell> cells_where(const auto& wanted) {
  std::vector<LedgerCell> cells;
  for (const LedgerColumn& column : ledger_columns)
    if (wanted(column))
      for (int axis = 0; axis < (is_vector(column) ? 3 : 1); ++axis) cells.push_back({&column, axis});
  return cells;
}

double& number(LedgerRow& row, std::string_view name) {
  const LedgerCell cell = find_ledger_cell(name);
  if (cell.column) {
    if (const auto* one = std::get_if<double LedgerRow::*>(&cell.column->value)) return row.**one;
    if (const auto* vector = std::get_if<Vec3d LedgerRow::*>(&cell.column->value)) return (row.**vector)[cell.axis];
  }
  fail_input("\"{}\" is no number of a ledger: must be a column of docs/reference/ledger.md", name);
}

}  // namespace

std::string LedgerCell::name() const {
  std::string text(column->name);
  if (is_vector(*column)) text += {'_', static_cast<char>('x' + axis)};
  return text;
}

std::vector<LedgerCell> ledger_cells(const LedgerKind& kind) {
  return cells_where([&](const LedgerColumn& c) { return kind.has(c.runs); });
}

LedgerCell find_ledger_cell(std::string_view name) {
  const std::vector<LedgerCell> all = cells_where([](const LedgerColumn&) { return true; });
  const auto at = std::find_if(all.begin(), all.end(), [&](const LedgerCell& cell) { return cell.name() == name; });
  return at == all.end() ? LedgerCell{} : *at;
}

double ledger_number(const LedgerRow& row, std::string_view name) {
  LedgerRow copy = row;
  return number(copy, name);
}
double& ledger_number(LedgerRow& row, std::string_view name) { return number(row, name); }

}  // namespace dreampm
