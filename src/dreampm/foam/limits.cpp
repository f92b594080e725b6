#include <cmath>

#include "dreampm/foam/rates.h"

namespace dreampm {
namespace {
using namespace foam;

constexpr float surface_tension = 0.072f, density = 1000;  ///< N/m and kg/m^3, of water
constexpr float grain = 0.25e-3f;                          ///< m, the diameter

/// What is slower emits nothing [m/s].
float least_speed(const FoamRules& rules) {
  const float gravity = std::max(1.0f, length(rules.gravity));
  return rules.dust ? slowest_splash(gravity) : 2 * slowest_wave(gravity);
}

/// The value that one in a hundred is above; 0 of none.
float high(std::vector<float>& values) {
  std::erase(values, 0.0f);
  if (values.empty()) return 0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(values.size() * 99 / 100);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

float slowest_wave(float gravity) { return std::sqrt(std::sqrt(4 * gravity * surface_tension / density)); }

float slowest_splash(float gravity) { return 40 * std::sqrt(gravity * grain); }

FoamMaxima foam_maxima(const FoamMatter& matter, std::span<const Obstacle> obstacles, const FoamRules& rules) {
  FoamMaxima out;
  const float slow = least_speed(rules);
  const std::size_t n = matter.position.size();
  out.moving = parallel_reduce(n, std::uint64_t{0},
                               [&](std::uint64_t& sum, std::size_t i) { sum += length(matter.velocity[i]) > slow; });
  if (out.moving == 0) return out;
  const Measures measures(matter, obstacles, rules);
  std::vector<Causes> causes(n);
  parallel_for(n, 1024, [&](std::size_t i) {
    if (length(matter.velocity[i]) > slow) causes[i] = causes_of(measures.at(matter.position[i]), matter.velocity[i]);
  });
  const auto of = [&](float Causes::* which) {
    std::vector<float> values;
    for (const Causes& c : causes) values.push_back(c.*which);
    return high(values);
  };
  out.speed = of(&Causes::speed), out.trapped_air = of(&Causes::trapped_air), out.crest = of(&Causes::crest);
  out.vorticity = of(&Causes::vorticity);
  return out;
}

FoamFound found_limits(std::span<const FoamMaxima> frames, const FoamRules& rules) {
  const auto mean = [&](float FoamMaxima::* which) {
    double sum = 0;
    std::size_t count = 0;
    for (const FoamMaxima& f : frames)
      if (f.*which > 0) sum += static_cast<double>(f.*which), ++count;
    return count > 0 ? static_cast<float>(sum / static_cast<double>(count)) : 0.0f;
  };
  // A tenth to all of the mean of the frames' maxima (Bender and others, SPlisHSPlasH), and never
  // so low that what keeps its surface would foam, or a heap that slides would smoke.
  const auto limits = [&](float most, float least) {
    const float from = std::max(least, 0.1f * most);
    return FoamCause{1, from, std::max(most, 2 * from)};
  };
  const float slow = least_speed(rules), meeting = rules.dust ? image_factor * slow : 0.5f * slow;
  return {limits(mean(&FoamMaxima::speed), slow), limits(mean(&FoamMaxima::trapped_air), meeting),
          limits(mean(&FoamMaxima::crest), 0.25f / rules.scale), limits(mean(&FoamMaxima::vorticity), slow)};
}

}  // namespace dreampm
