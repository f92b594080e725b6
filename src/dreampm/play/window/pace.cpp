#include "dreampm/play/window/pace.h"

namespace dreampm::play {
namespace {

/// Of what is asked for: below it the solver does not keep up, and above it it does again.
constexpr double slow_rate = 0.93, kept_rate = 0.98;
/// s, of the progress of a film that is made beside a world that stands still.
constexpr double progress_every = 0.25;

}  // namespace

bool PicturePace::shows_the_same(const Frame& frame) const {
  return frame.time == shown_.time && frame.steps == shown_.steps && frame.actions == shown_.actions &&
         frame.message_number == shown_.message && frame.past == shown_.past && frame.future == shown_.future;
}

bool PicturePace::is_due(const Frame& frame, double now, bool touched, double until) {
  if (touched) touched_ = now;
  const bool stands = frame.settings.paused;
  if (frame.number != seen_ && !stands) {
    seen_ = frame.number;
    rate_ += 0.1 * (frame.meters.rate - rate_);
    is_slow_ = rate_ < (is_slow_ ? kept_rate : slow_rate);
  }
  const double since = now - drawn_at_;
  if (!stands) return !is_slow_ || since > 0.98 / most_a_second;
  if (touched || now < touched_ + linger || now < until || !shows_the_same(frame) || !frame.film.empty()) return true;
  return frame.rendering && frame.rendering->under_way() && since > progress_every;
}

void PicturePace::drew(const Frame& frame, double now) {
  drawn_at_ = now;
  shown_ = {frame.time, frame.steps, frame.actions, frame.message_number, frame.past, frame.future};
}

}  // namespace dreampm::play
