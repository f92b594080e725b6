# Writes OUT, a C++ file that holds the text of every FOLDER/*.glsl by its name. Run by cmake -P.
file(GLOB files RELATIVE ${FOLDER} ${FOLDER}/*.glsl)
set(list "")
foreach(name IN LISTS files)
  file(READ ${FOLDER}/${name} text)
  string(REGEX REPLACE "\\.glsl$" "" stem ${name})
  string(APPEND list "  {\"${stem}\", R\"embed(${text})embed\"},\n")
endforeach()
file(WRITE ${OUT} "// Made by embed_shaders.cmake.
#include \"dreampm/base/error.h\"
#include \"dreampm/gl/shader_text.h\"\n
namespace dreampm::gl {\nnamespace {\nconstexpr ShaderFile all[] = {\n${list}};\n}
std::string_view shader_text(std::string_view name) {
  for (const ShaderFile& file : all)
    if (file.name == name) return file.text;
  fail_run(\"there is no shader {}.glsl\", name);
}
}\n")
