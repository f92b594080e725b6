#include "dreampm/import/point_file.h"

#include "dreampm/base/error.h"
#include "dreampm/import/bgeo.h"
#include "dreampm/import/gzip.h"
#include "dreampm/import/ply.h"
#include "dreampm/import/text_lines.h"
#include "dreampm/import/vtk_legacy.h"
#include "dreampm/import/vtk_xml.h"
#include "dreampm/import/vtkhdf.h"

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

Model parse_point_file(const std::string& kind, std::string_view text, const std::string& name) {
  if (text.empty()) fail_input("{}: is empty, points are wanted", name);
  const Kind* const known = find(kind);
  if (!known) fail_input("{}: points are read from {}", name, point_kinds());
  return known->parse(text, name);
}

Model read_point_file(const std::filesystem::path& path) {
  return parse_point_file(file_kind(path), read_unpacked(path), path.string());
}

}  // namespace dreampm
