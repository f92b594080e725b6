// Files that may be packed with gzip.
#pragma once
#include <string>
#include <string_view>

namespace dreampm {

/// Whether `bytes` start as a gzip file does.
bool is_gzip(std::string_view bytes);

/// The content of a gzip file (all its members). Throws InputError naming `name`: cut short, damaged (its check sum
/// fails), or more than 8 GiB unpacked.
std::string unpack_gzip(std::string_view bytes, const std::string& name);

}  // namespace dreampm
