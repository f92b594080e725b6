# Writes OUT, a C++ file that holds the text of every file in FOLDER (*.yaml and data/*.csv) by its name. Run by cmake -P.
file(GLOB files RELATIVE ${FOLDER} ${FOLDER}/*.yaml ${FOLDER}/data/*.csv)
set(parts "")
set(list "")
set(n 0)
foreach(name IN LISTS files)
  file(READ ${FOLDER}/${name} text)
  string(LENGTH "${text}" length)
  string(APPEND parts "constexpr std::string_view part_${n}[] = {\n")
  set(at 0)
  # Pieces, as compilers need not take literals of more than 65536 characters.
  while(at LESS length)
    string(SUBSTRING "${text}" ${at} 8000 piece)
    string(APPEND parts "R\"embed(${piece})embed\",\n")
    math(EXPR at "${at} + 8000")
  endwhile()
  string(APPEND parts "};\n")
  string(APPEND list "  {\"${name}\", part_${n}},\n")
  math(EXPR n "${n} + 1")
endforeach()
file(WRITE ${OUT} "// Made by embed.cmake from scenes/validation.\n#include \"validate/built_in.h\"\n
namespace dreampm::validate {\nnamespace {\n${parts}constexpr BuiltIn all[] = {\n${list}};\n}
std::span<const BuiltIn> built_in_files() { return all; }\n}\n")
