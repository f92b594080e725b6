// A film of what is shown, encoded on a thread of its own while pictures come.
#pragma once
#include <condition_variable>
#include <deque>
#include <exception>
#include <filesystem>
#include <mutex>
#include <thread>

#include "dreampm/image.h"

namespace dreampm::play {

class Recorder {
 public:
  static constexpr double longest_stand = 5;  ///< s

  Recorder(std::filesystem::path file, double fps);
  /// Ends the film. What goes wrong then is a warning: finish() throws it.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// The picture at that time [s] of any clock: it stands until the next one, so that the film is
  /// as fast as the clock; but no longer than longest_stand, such as while a window is minimised.
  /// All are made as large as the first, an odd row or column less: others lie in the middle. Waits
  /// while the encoder is behind. Throws what the encoder threw.
  void add(const RgbImage& picture, double time);
  /// Writes the file. Throws what the encoder threw.
  void finish();
  const std::filesystem::path& file() const { return file_; }
  double fps() const { return fps_; }
  /// Of film, until now.
  double seconds() const { return static_cast<double>(frames_) / fps_; }

 private:
  void push(RgbImage picture);
  void check();

  const std::filesystem::path file_;
  const double fps_;
  int width_ = 0, height_ = 0;
  double began_ = 0, last_time_ = 0;
  long frames_ = 0;  ///< given to the encoder
  RgbImage last_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<RgbImage> waiting_;
  bool ends_ = false, stopped_ = false;  ///< stopped_: the encoder takes no more
  std::exception_ptr failure_;
  std::thread thread_;
};

}  // namespace dreampm::play
