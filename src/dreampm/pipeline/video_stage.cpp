#include "dreampm/pipeline/video_stage.h"

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/base/hash.h"
#include "dreampm/base/log.h"
#include "dreampm/base/progress.h"
#include "dreampm/pipeline/render_stage.h"
#include "dreampm/video/contact_sheet.h"
#include "dreampm/video/encode.h"

namespace dreampm {
namespace fs = std::filesystem;
namespace {

std::string hash_of(const std::string& bytes) {
  Hash64 hash;
  hash.add(std::string_view(bytes));
  return hash.hex();
}

}  // namespace

fs::path video_file(const RunFolder& run) { return run.folder / (run.scene.name + ".mp4"); }

StageResult video_stage(RunFolder& run) {
  std::vector<fs::path> pictures;
  Hash64 bytes;
  for (const int f : run.frames()) {
    const fs::path file = picture_file(run, f);
    if (!fs::exists(file)) fail_input("{}: is missing; dreampm render {} makes it", file.string(), run.folder.string());
    bytes.add(std::string_view(hash_of(read_file(file))));
    pictures.push_back(file);
  }
  if (pictures.empty()) fail_input("{}: has no frames", run.folder.string());
  const VideoSettings settings{run.scene.time.fps, run.scene.video.quality};
  const Identity identity{{"pictures", bytes.hex()},
                          {"video settings", fmt::format("{} {}", settings.fps, settings.quality)}};

  // The table's one row stands for the film.
  make_folder(run.folder / "render");
  FrameTable table(run.folder / "render" / "video.csv");
  const fs::path film = video_file(run), sheet = run.folder / "contact-sheet.png";
  StageResult result;
  result.why = table.why_redo(1, identity);
  if (result.why.empty() && (!fs::exists(film) || !fs::exists(sheet))) result.why = "a file is not there";
  if (result.why.empty()) return result;

  const LogFile log(run.log_file());
  if (result.why != "new") info("video: {}: made again", result.why);
  StageCost cost(run, "video");
  table.remove(1);
  Progress progress("video: frame", pictures.size());
  record_end(run, "video", true, [&] {
    encode_video(pictures, film, settings, [&](std::size_t done) { progress.update(done); });
    write_contact_sheet(pictures, sheet);
    table.enter(1, identity);
  });
  cost.frames(pictures.size(), hash_of(identity[0].second + identity[1].second));
  result.made = 1;
  return result;
}

}  // namespace dreampm
