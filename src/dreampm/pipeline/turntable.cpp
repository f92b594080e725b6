#include "dreampm/pipeline/turntable.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dreampm/base/error.h"
#include "dreampm/math/camera_view.h"

namespace dreampm {

std::vector<model::Camera> turntable(const model::Camera& camera, const Box3d& box, double aspect, int pictures) {
  if (pictures < 1) fail_input("a turntable of {} pictures: must be 1 or more", pictures);
  std::vector<model::Camera> out;
  double distance = 0;
  for (int k = 0; k < pictures; ++k) {
    // A larger azimuth is to the left of the one who looks.
    const double turn = -360.0 * k / pictures;
    model::Camera c = camera;
    if (camera.fit_basin) {
      c.azimuth = camera.azimuth + turn;
      const CameraView view = camera_view(c, box, aspect);
      distance = std::max(distance, dot(box.center() - view.eye, view.forward));
      c.from = -view.forward, c.to = box.center();
    } else {
      const double angle = turn * std::numbers::pi / 180, cosine = std::cos(angle), sine = std::sin(angle);
      const Vec3d away = camera.from - camera.to;
      c.from = camera.to + Vec3d{away.x * cosine - away.z * sine, away.y, away.x * sine + away.z * cosine};
    }
    out.push_back(c);
  }
  if (camera.fit_basin)
    for (model::Camera& c : out) c.fit_basin = false, c.from = c.to + c.from * distance;
  return out;
}

}  // namespace dreampm
