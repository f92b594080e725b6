#include "dreampm/gl/shader_text.h"

#include <algorithm>
#include <cctype>

#include "dreampm/base/error.h"

namespace dreampm::gl {

namespace {

void append(std::string_view name, ShaderSource& out) {
  if (std::find(out.files.begin(), out.files.end(), name) != out.files.end()) return;
  const std::size_t number = out.files.size();
  out.files.push_back(name);
  if (number > 0) out.text += fmt::format("#line 1 {}\n", number);
  std::string_view rest = shader_text(name);
  constexpr std::string_view include = "#include \"";
  for (int line = 1; !rest.empty(); ++line) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view text = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (text.starts_with(include)) {
      const std::string_view file = text.substr(include.size(), text.rfind('"') - include.size());
      append(file.substr(0, file.rfind(".glsl")), out);
      out.text += fmt::format("#line {} {}\n", line + 1, number);
    } else {
      out.text += text;
      out.text += '\n';
    }
  }
}

}  // namespace

ShaderSource assemble_shader(std::string_view name) {
  ShaderSource source{"#version 330 core\n#line 1 0\n", {}};
  append(name, source);
  return source;
}

std::string with_file_names(std::string_view log, const std::vector<std::string_view>& files) {
  std::string out;
  while (!log.empty()) {
    const std::size_t end = std::min(log.find('\n'), log.size());
    std::string_view line = log.substr(0, end);
    log.remove_prefix(std::min(end + 1, log.size()));
    std::size_t digits = 0, number = 0;
    while (digits < line.size() && std::isdigit(static_cast<unsigned char>(line[digits])))
      number = 10 * number + static_cast<std::size_t>(line[digits++] - '0');
    if (digits > 0 && digits < line.size() && (line[digits] == ':' || line[digits] == '(') && number < files.size()) {
      out += fmt::format("{}.glsl", files[number]);
      line.remove_prefix(digits);
    }
    out += line;
    out += '\n';
  }
  return out;
}

}  // namespace dreampm::gl
