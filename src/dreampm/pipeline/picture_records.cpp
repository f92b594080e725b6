#include "dreampm/pipeline/picture_records.h"

#include <fmt/format.h>

#include <algorithm>

namespace dreampm {

void enter_picture(std::vector<PictureRecord>& list, const PictureRecord& picture) {
  const auto place = std::lower_bound(list.begin(), list.end(), picture.frame,
                                      [](const PictureRecord& p, int frame) { return p.frame < frame; });
  if (place != list.end() && place->frame == picture.frame)
    *place = picture;
  else
    list.insert(place, picture);
}

void keep_pictures(std::vector<PictureRecord>& list, const std::vector<int>& frames) {
  std::erase_if(
      list, [&](const PictureRecord& p) { return std::find(frames.begin(), frames.end(), p.frame) == frames.end(); });
}

std::string picture_line(const PictureRecord& p, int most_samples, double noise) {
  return fmt::format("{:.1f} samples a pixel, error {:.2g}; {:.2g} % of the pixels stopped at {} samples above {:.2g}",
                     p.samples, p.error, 100 * p.at_limit, most_samples, noise);
}

}  // namespace dreampm
