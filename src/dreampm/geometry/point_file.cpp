#include "dreampm/geometry/point_file.h"

#include <string_view>
#include <vector>

#include "dreampm/base/error.h"
#include "dreampm/geometry/bgeo.h"
#include "dreampm/geometry/gzip.h"
#include "dreampm/geometry/ply.h"
#include "dreampm/geometry/text_lines.h"
#include "dreampm/geometry/vtk_legacy.h"
#include "dreampm/geometry/vtk_xml.h"
#include "dreampm/geometry/vtkhdf.h"

namespace dreampm {
namespace {

struct Kind {
  const char* ending;
  Model (*parse)(std::string_view text, const std::string& name);
};
constexpr Kind kinds[]{{".ply", parse_ply},     {".vtk", parse_vtk},       {".vtp", parse_vtk_xml},
                       {".vtu", parse_vtk_xml}, {".vtkhdf", parse_vtkhdf}, {".bgeo", parse_bgeo}};

const Kind* find(const std::string& ending) {
  for (const Kind& k : kinds)
    if (ending == k.ending) return &k;
  return nullptr;
}

}  // namespace

std::string file_kind(const std::filesystem::path& path) { return lower(unpacked_name(path).extension().string()); }

bool is_point_kind(const std::string& kind) { return find(kind) != nullptr; }

std::string point_kinds() {
  std::string text;
  for (const Kind& k : kinds) text += (text.empty() ? "" : ", ") + std::string(k.ending);
  return text;
}

Model read_point_file(const std::filesystem::path& path) {
  const std::string name = path.string(), text = read_unpacked(path);
  if (text.empty()) fail_input("{}: is empty, points are wanted", name);
  const Kind* const kind = find(file_kind(path));
  if (!kind) fail_input("{}: points are read from {}", name, point_kinds());
  return kind->parse(text, name);
}

}  // namespace dreampm
