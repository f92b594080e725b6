// Numbers for the samples of a pixel: the R_d sequence (M. Roberts 2018), shifted by a hash of
// pixel and dimension.
#pragma once
#include <array>
#include <cstdint>

#include "dreampm/render/color.h"

namespace dreampm::trace {

/// The `index`-th sample of a stream; each next() is one more dimension.
class Sampler {
 public:
  Sampler(std::uint32_t stream, std::uint32_t index) : stream_(stream), index_(index) {}
  /// Uniform in [0, 1). The first eight dimensions are of low discrepancy over `index`, the others
  /// random.
  float next() {
    const std::uint32_t d = dimension_++;
    std::uint32_t v = hash32(stream_ ^ hash32(d + 1)) + steps[d % 8] * (index_ + 1);
    if (d >= 8) v += hash32(d * 0x9e3779b9u + index_);
    return unit_float(v);
  }

 private:
  /// 2^32 / phi^k with phi^9 = phi + 1.
  static constexpr std::array<std::uint32_t, 8> steps = [] {
    std::array<std::uint32_t, 8> a{};
    double x = 4294967296.0;
    for (auto& s : a) s = static_cast<std::uint32_t>(x /= 1.0850702454914508);
    return a;
  }();
  std::uint32_t stream_, index_, dimension_ = 0;
};

/// A stream of its own for each (seed, pass, i).
inline std::uint32_t stream_of(std::uint64_t seed, std::uint32_t pass, std::uint32_t i) {
  return hash32(hash32(hash32(static_cast<std::uint32_t>(seed)) ^ static_cast<std::uint32_t>(seed >> 32)) +
                pass * 0x632be5abu) ^
         hash32(i * 0x85157af5u + 1);
}

}  // namespace dreampm::trace
