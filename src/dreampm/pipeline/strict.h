// Does a ledger close? Every change of mass, momentum and angular momentum from row to row must be
// what walls, colliders, gravity, damping, force fields and leaving matter gave, to within
// rounding; and no energy may come from nowhere.
#pragma once
#include <optional>
#include <string>

#include "dreampm/base/error.h"
#include "dreampm/io/ledger.h"
#include "dreampm/run/ledger_observer.h"

namespace dreampm {

/// The ledger of a strict run does not close. The text names frame, quantity, gap and bound.
class LedgerBreach : public RunError {
 public:
  using RunError::RunError;
};

/// What does not close between two rows that follow each other, in words; nothing if all does.
/// Mass: to 1e-12, and the mass on the grid to 16 roundings. Momentum and angular momentum: to the
/// row's own momentum_bound and angular_bound. Energy: what no column accounts for, with what
/// transfers took of it at once, may be a loss, but a gain only to the row's energy_bound.
std::optional<std::string> ledger_breach(const LedgerRow& before, const LedgerRow& now);

/// Throws LedgerBreach at the end of a frame whose row does not close.
template <class R>
class StrictObserver final : public Observer {
 public:
  /// `ledger`: of the same engine, added to it before.
  explicit StrictObserver(const LedgerObserver<R>& ledger) : ledger_(ledger) {}
  void on_frame() override {
    if (!ledger_.before()) return;
    if (const auto breach = ledger_breach(*ledger_.before(), ledger_.row())) throw LedgerBreach(*breach);
  }

 private:
  const LedgerObserver<R>& ledger_;
};

}  // namespace dreampm
