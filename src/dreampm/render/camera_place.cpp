#include "dreampm/render/camera_place.h"

#include "dreampm/render/camera.h"

namespace dreampm {

CameraPlace camera_place(const RenderScene& scene, const RenderSettings& settings) {
  const trace::Camera camera(scene.camera, scene.basin, settings.width, settings.height);
  const auto w = static_cast<float>(settings.width), h = static_cast<float>(settings.height);
  CameraPlace out{camera.eye(),
                  normalized(camera.direction(w, h / 2) - camera.direction(0, h / 2)),
                  {},
                  camera.direction(w / 2, h / 2)};
  out.up = cross(out.right, out.forward);
  return out;
}

}  // namespace dreampm
