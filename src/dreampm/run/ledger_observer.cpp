#include "dreampm/run/ledger_observer.h"

#include <utility>

#include "dreampm/run/ledger_row.h"

namespace dreampm {

template <class R>
void LedgerObserver<R>::begin() {
  writer_.emplace(file_, ledger_kind(engine_.world()));
  row_.reset();
  on_frame();
}

template <class R>
const std::optional<LedgerRow>& LedgerObserver<R>::go_on() {
  writer_.emplace(file_, ledger_kind(engine_.world()), engine_.world().frame);
  const std::vector<LedgerRow> rows = read_ledger(file_).rows;
  row_ = rows.empty() ? std::nullopt : std::optional(rows.back());
  return row_;
}

template <class R>
void LedgerObserver<R>::on_frame() {
  before_ = std::exchange(row_, std::nullopt);
  row_ = ledger_row(std::as_const(engine_).world(), engine_.backend(), engine_.motion(), totals_.sums(),
                    before_ ? &*before_ : nullptr);
  writer_->append(*row_);
}

template class LedgerObserver<float>;
template class LedgerObserver<double>;

}  // namespace dreampm
