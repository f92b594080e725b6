// The text of the shaders in shaders/, part of the program.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace dreampm::gl {

struct ShaderFile {
  std::string_view name;  ///< without ".glsl"
  std::string_view text;
};

/// The text of shaders/NAME.glsl. Throws RunError if there is none.
std::string_view shader_text(std::string_view name);

/// The shader with `#include "NAME.glsl"` lines replaced by those files, once each, and #line
/// directives; files[n] is the file that the compiler calls source n.
struct ShaderSource {
  std::string text;
  std::vector<std::string_view> files;
};
ShaderSource assemble_shader(std::string_view name);

/// The compiler's words with the number of the source replaced by its file, whether it writes
/// 0:12(3) or 0(12).
std::string with_file_names(std::string_view log, const std::vector<std::string_view>& files);

}  // namespace dreampm::gl
