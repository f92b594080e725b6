#include "dreampm/play/window/picture_films.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <filesystem>
#include <utility>

#include "dreampm/base/log.h"
#include "dreampm/base/seconds_since.h"

namespace dreampm::play {
namespace {

std::string full_name(const std::filesystem::path& file) { return std::filesystem::absolute(file).string(); }

}  // namespace

PictureFilms::PictureFilms(Tell tell, Recorder::Encode encode) : tell_(std::move(tell)), encode_(std::move(encode)) {}

void PictureFilms::record(const Frame& frame, double time, const std::function<RgbImage()>& picture) {
  if (recorder_ && recorder_->file() != frame.film) end();
  if (frame.film != ended_) ended_.clear();
  if (frame.film.empty() || !ended_.empty()) return;
  try {
    if (!recorder_) begin(frame, time);
    if (!stands_) clock_ += time - last_time_;
    last_time_ = time;
    stands_ = !recorder_->has_room();
    if (!stands_) recorder_->add(picture(), clock_);
  } catch (...) {
    recorder_.reset();
    ended_ = frame.film;
    throw;
  }
}

void PictureFilms::begin(const Frame& frame, double time) {
  // Who films into the same file twice wants the second film.
  for (Ending& film : ending_)
    if (film.recorder->file() == frame.film) film.recorder->finish();
  recorder_ = std::make_unique<Recorder>(frame.film, frame.film_fps, encode_);
  clock_ = 0, last_time_ = time, stands_ = false;
}

bool PictureFilms::is_behind() const { return recorder_ && !recorder_->has_room(); }

void PictureFilms::wait_for_room() const {
  if (recorder_) recorder_->wait_for_room();
}

std::optional<double> PictureFilms::seconds() const {
  return recorder_ ? std::optional(recorder_->seconds()) : std::nullopt;
}

double PictureFilms::seconds_behind() const { return recorder_ ? recorder_->behind() : 0; }

void PictureFilms::save_last(std::string file) {
  if (saving_ || last_.shown().empty()) return;
  saving_.reset(new Saving{{std::move(file), LastSeconds::fps, encode_}, last_.shown()});
}

void PictureFilms::go_on_with_last(const std::function<RgbImage(const Frame&)>& picture) {
  if (!saving_) return;
  constexpr double part = 0.03;  // s
  const auto began = std::chrono::steady_clock::now();
  Saving& film = *saving_;
  try {
    for (; film.next < film.shown.size() && seconds_since(began) < part && film.to.has_room(); ++film.next) {
      const LastSeconds::Shown& one = film.shown[film.next];
      film.to.add(picture(*one.frame), one.time);
    }
    // The same words each time: they take one place among the messages.
    if (film.next < film.shown.size()) return tell_("saving the last seconds", false);
    const std::string file = film.to.file().string();
    film.to.end();
    if (!film.to.is_done()) return;
    film.to.finish();
    tell_(fmt::format("the last {:.1f} s are in {}", film.to.seconds(), full_name(file)), false);
    info("wrote {}", file);
  } catch (const std::exception& e) {
    tell_(fmt::format("the last seconds were not saved: {}", e.what()), true);
    warn("{}: {}", film.to.file().string(), e.what());
  }
  saving_.reset();
}

void PictureFilms::end() {
  if (!recorder_) return;
  recorder_->end();
  ended_ = recorder_->file().string();
  const std::string file = full_name(recorder_->file());
  ending_.push_back({std::move(recorder_), "filmed " + file});
}

void PictureFilms::conclude(Ending& film) {
  film.recorder->finish();
  info("wrote {}", film.recorder->file().string());
  tell_(film.done, false);
}

void PictureFilms::poll() {
  std::erase_if(ending_, [&](Ending& film) {
    if (!film.recorder->is_done()) return false;
    try {
      conclude(film);
    } catch (const std::exception& e) {
      warn("no film: {}", e.what());
      tell_(fmt::format("no film: {}", e.what()), true);
    }
    return true;
  });
}

bool PictureFilms::is_in_use(const std::string& file) const {
  return (recorder_ && recorder_->file() == file) || (saving_ && saving_->to.file() == file) ||
         std::any_of(ending_.begin(), ending_.end(), [&](const Ending& f) { return f.recorder->file() == file; });
}

void PictureFilms::finish() {
  end();
  ended_.clear();
  for (std::vector<Ending> films = std::exchange(ending_, {}); Ending & film : films) conclude(film);
}

}  // namespace dreampm::play
