// Writes ledger.csv while an engine steps.
#pragma once
#include <filesystem>
#include <optional>

#include "dreampm/io/ledger.h"
#include "dreampm/run/engine.h"
#include "dreampm/run/frame_sums.h"

namespace dreampm {

template <class R>
class LedgerObserver final : public Observer {
 public:
  /// `totals`: of the same engine, added to it before.
  LedgerObserver(Engine<R>& engine, const FrameTotals<R>& totals, std::filesystem::path file)
      : engine_(engine), totals_(totals), file_(std::move(file)) {}
  /// Begins a new file with the row of the moment at hand.
  void begin();
  /// Goes on after the row of the world's frame; rows after it are cut. Throws InputError as
  /// LedgerWriter does. The last row that is left, if there is any.
  const std::optional<LedgerRow>& go_on();

  /// The row of the last frame, and the one before it.
  const LedgerRow& row() const { return *row_; }
  const std::optional<LedgerRow>& before() const { return before_; }

  /// Appends the row of the frame that has ended.
  void on_frame() override;

 private:
  Engine<R>& engine_;
  const FrameTotals<R>& totals_;
  std::filesystem::path file_;
  std::optional<LedgerWriter> writer_;
  std::optional<LedgerRow> row_, before_;
};

}  // namespace dreampm
