#include "dreampm/pipeline/frame_stages.h"

#include <array>

#include "dreampm/pictures/draw.h"
#include "dreampm/pipeline/foam_stage.h"
#include "dreampm/pipeline/render_stage.h"
#include "dreampm/pipeline/surface_stage.h"

namespace dreampm {
namespace {

StageResult make_pictures(RunFolder& run, const FrameRange& frames) {
  RenderOptions options;
  options.first = frames.first, options.last = frames.last;
  return render_stage(run, options);
}

std::string missing_surface(const RunFolder& run, const std::vector<int>& frames) {
  return meshed_materials(run.scene).empty() ? std::string() : no_surface(run, frames);
}

}  // namespace

std::span<const FrameStage> frame_stages() {
  static constexpr std::array<FrameStage, 3> all{{
      {"foam", foam_stage, no_foam, true},
      {"surface", surface_stage, missing_surface},
      {"render", make_pictures, no_picture},
  }};
  return all;
}

}  // namespace dreampm
