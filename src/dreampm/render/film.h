// The film: samples of pixels until their error as shown is small enough.
#pragma once
#include <functional>
#include <vector>

#include "dreampm/render/camera.h"
#include "dreampm/render/first_hit.h"
#include "dreampm/render/integrator.h"

namespace dreampm::trace {

class Film {
 public:
  /// What is exposed; all of it must outlive the film.
  struct View {
    const Integrator& integrator;
    const Camera& camera;
    const FirstHits* firsts = nullptr;  ///< keeps what the first surfaces are like
    bool moves = false;                 ///< samples are spread over the exposure
    double frame_time = 1;              ///< s
  };
  /// Of the pixels of `box` of a frame. `clamp`: cuts fireflies.
  Film(const RenderSettings& settings, const PixelBox& box, const View& view, bool clamp);

  /// Brings every pixel to its wanted number of samples.
  void expose(const std::function<void(double)>& progress);
  /// Asks for more samples where the error as shown, of the pixel or a neighbor, is above the
  /// noise asked for.
  void ask_more();
  std::vector<Vec3f> linear() const;
  FirstSurfaces surfaces() const;
  /// Of the pixels of a part of the box.
  RenderReport report(const PixelBox& part) const;

 private:
  /// Samples of one pixel so far.
  struct Pixel {
    Vec3f sum;
    Vec3f shown, shown2;  ///< sums of each channel as shown, and of its square
    int count = 0;
    /// The standard error of the mean, the root mean square over the channels: edges between
    /// colors of one lightness count, too.
    float error() const;
  };
  struct Aside {
    Vec3f normal, albedo;  ///< sums
  };
  /// The largest step to a pixel beside, as shown, less what noise may make of it.
  float edge_at(std::size_t x, std::size_t y, const std::vector<float>& error) const;
  void expose_tile(std::size_t tx, std::size_t ty);
  void expose_pixel(std::size_t i, int x, int y);

  RenderSettings settings_;
  PixelBox box_;
  View view_;
  bool clamp_;
  std::size_t width_, height_;
  std::vector<Pixel> pixels_;
  std::vector<Aside> asides_;
  std::vector<int> wanted_;
};

}  // namespace dreampm::trace
