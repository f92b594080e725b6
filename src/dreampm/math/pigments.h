// The colors of mixed matter. Dyes and paints mix by what each takes out of the light, not by the
// light itself: blue and yellow give green.
//
// Opaque matter scatters and absorbs: Kubelka and Munk, "Ein Beitrag zur Optik der Farbanstriche"
// (1931). Of a thick layer, the share R of light that comes back has K/S = (1 - R)^2 / (2 R), and
// the K and S of parts add up by their amounts. All parts are taken to scatter alike. Clear matter
// only absorbs, and its coefficients -ln T, of the light T that passes, add up (Beer-Lambert).
//
// Both hold for each wavelength. Colors become reflectances in bands of light and back, what is
// lost on that way is mixed as light and added, and so a color mixed with itself stays what it is
// (after Sochorova and Jamriska, "Practical pigment mixing for digital painting", 2021). The
// reflection of a coat (Saunderson 1942) is no part of a color here: looks have their own.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "dreampm/math/vec.h"

namespace dreampm {

/// How matter of several colors mixes.
enum class Mixing {
  opaque,  ///< it scatters light, as paint, snow and sand do
  clear    ///< it only absorbs, as dyed water does
};

namespace pigments {

inline constexpr std::size_t band_count = 12;
inline constexpr int first_nm = 400, band_nm = 25;
using Bands = std::array<float, band_count>;

/// The relative power of CIE illuminant D65 (CIE 15) at 400, 410 .. 700 nm.
inline constexpr std::array<double, 31> d65{82.7549, 91.4860, 93.4318, 86.6823, 104.865, 117.008, 117.812, 114.861,
                                            115.923, 108.811, 109.354, 107.802, 104.790, 107.689, 104.405, 104.046,
                                            100.000, 96.3342, 95.7880, 88.6856, 90.0062, 89.5991, 87.6987, 83.2886,
                                            83.6992, 80.0268, 80.2146, 82.2778, 78.2842, 69.7213, 71.6091};

/// X, Y and Z of light of a wavelength [nm]: Wyman, Sloan and Shirley, "Simple analytic
/// approximations to the CIE XYZ color matching functions" (2013), equation 4.
inline Vec3d matching(double nm) {
  const auto lobe = [nm](double height, double center, double below, double above) {
    const double t = (nm - center) * (nm < center ? below : above);
    return height * std::exp(-0.5 * t * t);
  };
  return {lobe(0.362, 442.0, 0.0624, 0.0374) + lobe(1.056, 599.8, 0.0264, 0.0323) + lobe(-0.065, 501.1, 0.0490, 0.0382),
          lobe(0.821, 568.8, 0.0213, 0.0247) + lobe(0.286, 530.9, 0.0613, 0.0322),
          lobe(1.217, 437.0, 0.0845, 0.0278) + lobe(0.681, 459.0, 0.0385, 0.0725)};
}

struct Tables {
  std::array<Vec3f, band_count> light;    ///< linear sRGB of each band under D65; they add up to white
  std::array<Vec3f, band_count> primary;  ///< reflectances of red, green and blue; they add up to 1
};

/// Reflectances of pigments rise and fall in S-shaped edges. Blue ends and red begins in one, and
/// green is between; the edges lie where typical blue and yellow pigments overlap in green.
inline Tables make_tables() {
  constexpr double blue_end = 510, red_begin = 590, width = 12;  // nm
  const auto edge = [](double t) { return 1 / (1 + std::exp(-t)); };
  Tables out;
  std::array<Vec3d, band_count> light{};
  Vec3d white{};
  for (std::size_t b = 0; b < band_count; ++b) {
    const int low = first_nm + static_cast<int>(b) * band_nm;
    for (int nm = low; nm < low + band_nm; ++nm) {
      const std::size_t i = static_cast<std::size_t>(nm - first_nm) / 10;
      const double power = d65[i] + 0.1 * (nm - first_nm - 10 * static_cast<int>(i)) * (d65[i + 1] - d65[i]);
      const Vec3d xyz = matching(nm) * power;
      light[b] +=
          Vec3d{3.2406 * xyz.x - 1.5372 * xyz.y - 0.4986 * xyz.z,  // IEC 61966-2-1
                -0.9689 * xyz.x + 1.8758 * xyz.y + 0.0415 * xyz.z, 0.0557 * xyz.x - 0.2040 * xyz.y + 1.0570 * xyz.z};
    }
    white += light[b];
    const double middle = low + 0.5 * band_nm;
    const double blue = edge((blue_end - middle) / width), red = edge((middle - red_begin) / width);
    out.primary[b] = static_cast<Vec3f>(Vec3d{red, 1 - red - blue, blue});
  }
  for (std::size_t b = 0; b < band_count; ++b)
    out.light[b] = static_cast<Vec3f>(Vec3d{light[b].x / white.x, light[b].y / white.y, light[b].z / white.z});
  return out;
}
inline const Tables& tables() {
  static const Tables made = make_tables();
  return made;
}

inline Vec3f color_of(const Bands& reflectance) {
  Vec3f color{};
  for (std::size_t b = 0; b < band_count; ++b) color += tables().light[b] * reflectance[b];
  return color;
}

/// Nothing is blacker: it would outweigh all that it is mixed with.
inline constexpr float least_reflectance = 0.02f;

}  // namespace pigments

/// A color as what it takes out of the light.
struct Pigment {
  pigments::Bands absorbs{};  ///< K/S, or -ln T of clear matter, in each band
  Vec3f rest{};               ///< linear sRGB, what the bands do not hold

  /// Of a linear color with components of 0 to 1.
  static Pigment of(const Vec3f& linear, Mixing mixing) {
    Pigment out;
    pigments::Bands reflectance{};
    for (std::size_t b = 0; b < pigments::band_count; ++b) {
      const float r = std::clamp(dot(pigments::tables().primary[b], linear), pigments::least_reflectance, 1.0f);
      reflectance[b] = r;
      out.absorbs[b] = mixing == Mixing::opaque ? (1 - r) * (1 - r) / (2 * r) : -std::log(r);
    }
    out.rest = linear - pigments::color_of(reflectance);
    return out;
  }
};

/// Adds up pigments by their amounts.
class PigmentMix {
 public:
  explicit PigmentMix(Mixing mixing) : mixing_(mixing) {}
  /// `amount`: above 0, in any unit.
  void add(const Pigment& p, float amount) {
    for (std::size_t b = 0; b < pigments::band_count; ++b) sum_.absorbs[b] += p.absorbs[b] * amount;
    sum_.rest += p.rest * amount;
    amount_ += amount;
  }
  /// Linear, with components of 0 to 1. Something must have been added.
  Vec3f color() const {
    pigments::Bands reflectance{};
    for (std::size_t b = 0; b < pigments::band_count; ++b) {
      const float k = sum_.absorbs[b] / amount_;
      reflectance[b] = mixing_ == Mixing::opaque ? 1 / (1 + k + std::sqrt(k * (k + 2))) : std::exp(-k);
    }
    Vec3f color = pigments::color_of(reflectance) + sum_.rest / amount_;
    for (int c = 0; c < 3; ++c) color[c] = std::clamp(color[c], 0.0f, 1.0f);
    return color;
  }

 private:
  Mixing mixing_;
  Pigment sum_;
  float amount_ = 0;
};

}  // namespace dreampm
