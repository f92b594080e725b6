#include "dreampm/pipeline/loose_names.h"

#include <map>

#include "dreampm/base/error.h"
#include "dreampm/import/gzip.h"

namespace dreampm {
namespace fs = std::filesystem;

std::vector<fs::path> loose_names(const std::vector<std::string>& files, const fs::path& out,
                                  const std::string& extension) {
  if (fs::exists(out) && !fs::is_directory(out)) fail_input("{}: is a file; --out names a folder", out.string());
  std::map<std::string, std::string> by_stem;
  std::vector<fs::path> names;
  for (const std::string& file : files) {
    if (!fs::exists(file)) fail_input("{}: no such file", file);
    if (fs::is_directory(file)) fail_input("{}: is a folder among files; name the files in it", file);
    const std::string stem = unpacked_name(file).stem().string();
    if (const auto [other, fresh] = by_stem.emplace(stem, file); !fresh)
      fail_input("{} and {}: both would become {}{}", other->second, file, stem, extension);
    names.push_back(out / (stem + extension));
  }
  for (const fs::path& name : names)
    for (const std::string& file : files)
      if (fs::exists(name) && fs::equivalent(name, file))
        fail_input("{}: would be written over; name another folder with --out", file);
  return names;
}

}  // namespace dreampm
