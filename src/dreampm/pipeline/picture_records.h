// The list of pictures in a run's record.
#pragma once
#include <string>
#include <vector>

#include "dreampm/io/run_record.h"

namespace dreampm {

/// Puts a record in the place of its frame, instead of the one that is there.
void enter_picture(std::vector<PictureRecord>& list, const PictureRecord& picture);
/// Forgets those of other frames.
void keep_pictures(std::vector<PictureRecord>& list, const std::vector<int>& frames);
/// "12.3 samples a pixel, error 0.008; 1.5 % of the pixels stopped at 40 samples above 0.009"
std::string picture_line(const PictureRecord& picture, int most_samples, double noise);

}  // namespace dreampm
