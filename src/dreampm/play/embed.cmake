# Writes OUT, a C++ file that holds the text of every scene in FOLDER (*.yaml) by its name. Run by cmake -P.
file(GLOB files RELATIVE ${FOLDER} ${FOLDER}/*.yaml)
set(list "")
foreach(name IN LISTS files)
  file(READ ${FOLDER}/${name} text)
  string(LENGTH "${text}" length)
  # Compilers need not take literals of more than 65536 characters.
  if(length GREATER 60000)
    message(FATAL_ERROR "${FOLDER}/${name} has ${length} characters: a story has at most 60000")
  endif()
  string(REGEX REPLACE "\\.yaml$" "" stem "${name}")
  string(APPEND list "    {\"${stem}\", R\"embed(${text})embed\"},\n")
endforeach()
file(WRITE ${OUT} "// Made by embed.cmake from scenes/play.\n#include \"dreampm/play/model/story_files.h\"\n
namespace dreampm::play {\nnamespace {\nconstexpr StoryFile all[] = {\n${list}};\n}
std::span<const StoryFile> story_files() { return all; }\n}\n")
