// A frame's row of the ledger.
#pragma once
#include <string>
#include <vector>

#include "dreampm/io/ledger.h"
#include "dreampm/pipeline/checkpoint.h"
#include "dreampm/solver/balance.h"

namespace dreampm {

/// All columns of the format. `sums`: of the steps since the row `before`, or null for the first.
template <class R>
LedgerRow ledger_row(const World<R>& world, const Motion<R>& motion, const FrameSums& sums, const LedgerRow* before);

}  // namespace dreampm
