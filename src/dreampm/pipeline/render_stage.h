// The render stage: a picture of every frame, from its meshes and its particles.
#pragma once
#include <optional>

#include "dreampm/pipeline/stage.h"
#include "dreampm/render/render.h"

namespace dreampm {

/// `samples`: at most, a pixel. Throws InputError for a scale that is not above 0 and at most 4,
/// and for less than 2 samples.
RenderSettings scaled(RenderSettings settings, double scale, const std::optional<int>& samples);

struct RenderOptions {
  int first = 0, last = 0;     ///< frames to draw, both included; 0, 0: all
  double scale = 1;            ///< of the picture's size
  std::optional<int> samples;  ///< the scene's own number if absent
};

/// render/render_000001.png
std::filesystem::path picture_file(const RunFolder& run, int frame);
/// What a picture depends on; `run` must outlive it.
std::function<Identity(int frame)> render_identity(const RunFolder& run, const RenderOptions& options = {});

/// Why one of the frames has no picture that is up to date, and what makes it; empty if all have.
std::string no_picture(const RunFolder& run, const std::vector<int>& frames);

/// Draws the pictures that are not up to date; one of another scale or number of samples is not.
/// Throws InputError for a frame that is not simulated and one whose surface is missing or not up
/// to date.
StageResult render_stage(RunFolder& run, const RenderOptions& options = {});

}  // namespace dreampm
