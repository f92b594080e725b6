// Names of what is made of files, one for each.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace dreampm {

/// OUT/NAME.EXTENSION for each file. Writes nothing, nor makes the folder. Throws InputError for
/// two files of one name, where a file would be written over, and for a file as OUT.
std::vector<std::filesystem::path> loose_names(const std::vector<std::string>& files, const std::filesystem::path& out,
                                               const std::string& extension);

}  // namespace dreampm
