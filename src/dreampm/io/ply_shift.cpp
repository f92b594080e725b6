#include <charconv>
#include <cmath>
#include <string_view>

#include "dreampm/base/error.h"
#include "dreampm/import/point_file.h"
#include "dreampm/io/ply.h"

namespace dreampm {

std::string ply_shift_comment(const Vec3d& shift) {
  return shift == Vec3d{} ? "" : fmt::format("comment shift {} {} {}\n", shift.x, shift.y, shift.z);
}

Vec3d ply_shift(const PlyHeader& header, const std::string& file) {
  constexpr std::string_view key = "shift ";
  Vec3d shift;
  for (const std::string& comment : header.comments) {
    if (!comment.starts_with(key)) continue;
    const char *at = comment.data() + key.size(), *const end = comment.data() + comment.size();
    for (int a = 0; a < 3; ++a) {
      while (at != end && *at == ' ') ++at;
      const auto [stop, error] = std::from_chars(at, end, shift[a]);
      if (error != std::errc() || !std::isfinite(shift[a]))
        fail_input("{}: \"comment {}\" does not read \"comment shift X Y Z\" with three numbers", file, comment);
      at = stop;
    }
  }
  return shift;
}

Vec3d read_ply_shift(const std::filesystem::path& file) {
  return file_kind(file) == ".ply" ? ply_shift(read_ply_header(file), file.string()) : Vec3d{};
}

}  // namespace dreampm
