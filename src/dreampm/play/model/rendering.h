// A film that is made beside the playground: what it will take, then `dreampm make`, each in a
// process of its own.
#pragma once
#include <sys/types.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "dreampm/play/model/frame.h"

namespace dreampm::play {

class Rendering {
 public:
  /// Estimates what the scene will take, and, where `goes_on`, makes the film then. `program`: the
  /// file of the command dreampm. `backend`: of the film's simulation. Lines of the run go to a
  /// file beside the scene, its ending `.log`. Throws RunError where no process can be started.
  /// `patience`: how long what is interrupted may take to end before it is killed.
  Rendering(std::filesystem::path program, std::filesystem::path scene, std::string backend, bool goes_on,
            std::chrono::milliseconds patience = std::chrono::seconds(10));
  /// Interrupts what runs, which `dreampm make` goes on with, and waits until it has ended, for as
  /// long as `patience` at most.
  ~Rendering();
  Rendering(const Rendering&) = delete;
  Rendering& operator=(const Rendering&) = delete;

  /// Nothing happens where nothing runs. What is done is kept; of what was only estimated nothing.
  void stop();
  /// It goes on beside whatever comes, and is not looked after any more.
  void leave();
  /// What it has come to by now.
  const RenderStatus& look();

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::size_t stages = 4;

  void start(const std::vector<std::string>& words, int output);
  void make();
  void discard();
  void read_estimate();
  void read_log();
  void read_line(const std::string& line);
  void expect_rest();
  void end(int code);

  std::filesystem::path program_, scene_, log_;
  const std::string backend_;
  const bool goes_on_;
  const std::chrono::milliseconds patience_;
  bool stops_ = false;
  pid_t child_ = -1;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> answer_;  ///< of the estimate
  std::array<double, stages> expected_{};                   ///< s, of each stage
  std::size_t stage_ = 0;
  int first_done_ = 0;                        ///< frames that it began with
  Clock::time_point stage_began_, reported_;  ///< reported_: when the line of the last progress came
  std::streamoff read_ = 0;                   ///< bytes of the log
  std::string line_, last_error_;
  std::vector<std::string> printed_;
  RenderStatus status_;
};

/// Opens a film in whatever the desktop plays films with, if it has anything.
void show_film(const std::string& file);

}  // namespace dreampm::play
