// Files that may be packed with gzip.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

namespace dreampm {

/// True if `bytes` start as a gzip file does.
bool is_gzip(std::string_view bytes);

/// The name without .gz, in upper or lower case.
std::filesystem::path unpacked_name(std::filesystem::path path);

/// The content of a gzip file (all its members). Throws InputError naming `name`: cut short,
/// damaged (its check sum fails), or more than 8 GiB unpacked.
std::string unpack_gzip(std::string_view bytes, const std::string& name);

/// The whole file, unpacked if it is a gzip file, whatever its name. Throws InputError if it cannot
/// be read.
std::string read_unpacked(const std::filesystem::path& path);

}  // namespace dreampm
