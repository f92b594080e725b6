// A frame's row of the ledger.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "dreampm/backend/backend.h"
#include "dreampm/io/ledger.h"
#include "dreampm/run/frame_sums.h"

namespace dreampm {

/// The columns that the rows of a world have.
template <class R>
LedgerKind ledger_kind(const World<R>& world);

/// A row with all that `ledger_kind` asks for. `backend`: the one that steps the world; `motion`:
/// of the last pass; `sums`: of the steps since the row `before`, which is null for the first.
template <class R>
LedgerRow ledger_row(const World<R>& world, Backend<R>& backend, const Motion<R>& motion, const FrameSums& sums,
                     const LedgerRow* before);

/// The beginning of the warning that a calm liquid fills more than its volume.
inline constexpr std::string_view swollen_warning_start = "liquid takes more than its volume";

/// Looks for liquids that take over a tenth more than their volume while all matter is calm. Of
/// less than 27 cells of liquid nothing is said: the density is not known that well.
class SwollenWatch {
 public:
  /// A warning, if they do so since the longest flight that calm matter can make: 2 sqrt(dx/g) at a
  /// speed of sqrt(g dx), which its mean kinetic energy is below. No motion holds older gaps open.
  /// Rows in their order.
  template <class R>
  std::optional<std::string> look(const World<R>& world, const LedgerRow& row);

 private:
  std::optional<double> since_;  ///< s
};

}  // namespace dreampm
