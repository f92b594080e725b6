// Where the camera of a picture stands, for other programs.
#pragma once
#include "dreampm/render/render.h"

namespace dreampm {

struct CameraPlace {
  Vec3f eye;                 ///< m
  Vec3f right, up, forward;  ///< unit length
};
CameraPlace camera_place(const RenderScene& scene, const RenderSettings& settings);

}  // namespace dreampm
