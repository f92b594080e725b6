// The video stage: the pictures of a run as a film and a contact sheet.
#pragma once
#include "dreampm/pipeline/stage.h"

namespace dreampm {

/// NAME.mp4
std::filesystem::path video_file(const RunFolder& run);

/// Writes NAME.mp4 and contact-sheet.png unless they are up to date. Throws InputError naming the
/// picture that is missing or of another size.
StageResult video_stage(RunFolder& run);

}  // namespace dreampm
