# Writes OUT, a C++ file that holds the bytes of every picture in FOLDER (*.png) by its name. Run by cmake -P.
file(GLOB files RELATIVE ${FOLDER} ${FOLDER}/*.png)
set(arrays "")
set(list "")
set(number 0)
foreach(name IN LISTS files)
  file(READ ${FOLDER}/${name} bytes HEX)
  string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
  string(REGEX REPLACE "\\.png$" "" stem "${name}")
  string(APPEND arrays "constexpr unsigned char file_${number}[] = {${bytes}};\n")
  string(APPEND list "    {\"${stem}\", file_${number}},\n")
  math(EXPR number "${number} + 1")
endforeach()
file(WRITE ${OUT} "// Made by embed_pictures.cmake from scenes/play/pictures.\n#include \"dreampm/play/model/story_files.h\"\n
namespace dreampm::play {\nnamespace {\n${arrays}constexpr PictureFile all[] = {\n${list}};\n}
std::span<const PictureFile> picture_files() { return all; }\n}\n")
