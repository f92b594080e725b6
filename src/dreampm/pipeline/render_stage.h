// The render stage: a picture of every frame, from its meshes and its particles.
#pragma once
#include <optional>

#include "dreampm/pipeline/stage.h"
#include "dreampm/render/render.h"

namespace dreampm {

/// What a call asks for beside what the scene says.
struct PictureWishes {
  double scale = 1;            ///< of the picture's size
  std::optional<int> samples;  ///< at most, a pixel; the scene's own number if absent
  bool exr = false;            ///< an OpenEXR file beside the PNG
  bool denoise = false;
};

/// Throws InputError for a scale that is not above 0 and at most 4, for less than 2 samples, and
/// for a picture that is to be denoised where there is no denoiser.
RenderSettings wished(RenderSettings settings, const PictureWishes& wishes);

/// Writes a picture, and an OpenEXR file of the same name if it has what that holds.
void write_picture(const std::filesystem::path& png, const Picture& picture);

struct RenderOptions {
  int first = 0, last = 0;  ///< frames to draw, both included; 0, 0: all
  PictureWishes wishes;
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

/// Draws parts of frames to `out`, as crop_000001.png: their pixels are those of the whole
/// pictures. Those are left as they are. Throws as render_stage does.
std::vector<std::filesystem::path> render_part(const RunFolder& run, const RenderOptions& options, const PixelBox& part,
                                               const std::filesystem::path& out);

/// Draws one frame from places on a circle round the scene to `out`, as turntable_000001.png: the
/// first where the scene's camera stands, the next to its right. Throws as render_stage does.
std::vector<std::filesystem::path> render_turntable(const RunFolder& run, int frame, int pictures,
                                                    const PictureWishes& wishes, const std::filesystem::path& out);

}  // namespace dreampm
