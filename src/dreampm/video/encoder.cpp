#include "dreampm/video/encoder.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <sstream>
#include <string>

#include "dreampm/base/error.h"

namespace dreampm {
namespace fs = std::filesystem;
namespace {

#ifdef DM_LIBAV
constexpr bool has_libav = true;
#else
constexpr bool has_libav = false;
#endif

bool is_program(const fs::path& file) { return fs::is_regular_file(file) && ::access(file.c_str(), X_OK) == 0; }

std::optional<fs::path> on_path(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (const fs::path file = fs::path(folder.empty() ? "." : folder) / name; is_program(file)) return file;
  return std::nullopt;
}

/// Returns nothing: the libraries encode.
std::optional<fs::path> encoder_program() {
  const char* named = std::getenv("DREAMPM_FFMPEG");
  if (named && *named) {
    const std::string name = named;
    if (name.find('/') == std::string::npos) {
      if (const auto file = on_path(name)) return file;
    } else if (is_program(name)) {
      return name;
    }
    fail_run("DREAMPM_FFMPEG is {}: no such program; name an ffmpeg that has libx264", name);
  }
  if (has_libav) return std::nullopt;
  if (const auto file = on_path("ffmpeg")) return file;
  fail_run(
      "no film can be made: the program ffmpeg is not on the PATH. Install it, or `pip install imageio-ffmpeg` where "
      "dreampm came by pip, or name it by DREAMPM_FFMPEG. `dreampm run`, `surface` and `render` do without");
}

}  // namespace

void check_encoder() { encoder_program(); }

std::unique_ptr<Encoder> open_encoder(const FilmFile& film) {
  const std::optional<fs::path> program = encoder_program();
#ifdef DM_LIBAV
  if (!program) return open_libav_encoder(film);
#endif
  return open_program_encoder(*program, film);
}

int group_size(double fps) { return std::clamp(static_cast<int>(std::lround(2 * fps)), 1, 480); }

}  // namespace dreampm
