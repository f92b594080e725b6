// The files of scenes/validation, as they were when this was built.
#pragma once
#include <span>
#include <string_view>

namespace dreampm::validate {

struct BuiltIn {
  std::string_view name;                    ///< such as bar-wave.yaml or data/turek_hron_csm.csv
  std::span<const std::string_view> parts;  ///< its text, in pieces
};
std::span<const BuiltIn> built_in_files();

}  // namespace dreampm::validate
