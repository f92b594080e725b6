// Noise taken out of a picture by Open Image Denoise, a library that is looked for when it is
// asked for: the file that DREAMPM_OIDN names, else libOpenImageDenoise.so.2 where the system looks
// for libraries.
#pragma once
#include <string>
#include <vector>

#include "dreampm/math/vec.h"

namespace dreampm {

struct DenoiserState {
  bool found = false;
  std::string text;  ///< its version and file, or why there is none and what to install
};
/// Loads the library if it can.
DenoiserState find_denoiser();

/// Throws InputError with what to install where there is no denoiser.
void check_denoiser();

/// Replaces linear radiance by what it is without noise; the same bits for any number of threads.
/// `albedo` and `normal` are those of the first surfaces, as noisy as they are; row by row. Throws
/// InputError where there is no denoiser, RunError where it fails.
void denoise(std::vector<Vec3f>& linear, const std::vector<Vec3f>& albedo, const std::vector<Vec3f>& normal, int width,
             int height);

}  // namespace dreampm
