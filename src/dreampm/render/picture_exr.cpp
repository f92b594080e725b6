#include "dreampm/render/picture_exr.h"

#include <fmt/format.h>

#include "dreampm/version.h"

namespace dreampm {

ExrPicture exr_of(const Picture& p) {
  ExrPicture out;
  out.width = p.box.width(), out.height = p.box.height();
  out.x = p.box.x0, out.y = p.box.y0;
  out.full_width = p.width, out.full_height = p.height;
  const auto add = [&](const char* name, bool half, const auto& value) {
    ExrChannel& c = out.channels.emplace_back(ExrChannel{name, half, {}});
    c.values.reserve(p.box.size());
    for (int y = p.box.y0; y < p.box.y1; ++y)
      for (int x = p.box.x0; x < p.box.x1; ++x)
        c.values.push_back(
            value(static_cast<std::size_t>(y - p.traced.y0) * static_cast<std::size_t>(p.traced.width()) +
                  static_cast<std::size_t>(x - p.traced.x0)));
  };
  const auto add_vector = [&](std::array<const char*, 3> names, const std::vector<Vec3f>& values) {
    for (int k = 0; k < 3; ++k)
      add(names[static_cast<std::size_t>(k)], true, [&](std::size_t i) { return values[i][k]; });
  };
  add_vector({"R", "G", "B"}, p.linear);
  add("A", true, [](std::size_t) { return 1.0f; });
  const FirstSurfaces& s = p.surfaces;
  if (!s.depth.empty()) {
    add("Z", false, [&](std::size_t i) { return s.depth[i]; });
    add_vector({"normal.X", "normal.Y", "normal.Z"}, s.normal);
    add_vector({"albedo.R", "albedo.G", "albedo.B"}, s.albedo);
    add("motion.X", false, [&](std::size_t i) { return s.motion[i][0]; });
    add("motion.Y", false, [&](std::size_t i) { return s.motion[i][1]; });
  }
  out.notes["software"] = fmt::format("DreaMPM {}", version);
  out.notes["comments"] = fmt::format(
      "linear Rec. 709 light; Z in m along the line of sight; normals in the scene's axes, Y up; motion in pixels from "
      "frame to frame, to the right and up; {:.2f} samples a pixel, error {:.3g}",
      p.report.samples, p.report.error);
  return out;
}

}  // namespace dreampm
