// Adding to a text file so that a killed run leaves whole rows and a full disk none by half.
#pragma once
#include <filesystem>
#include <string>

namespace dreampm {

/// Adds `text` to the end of an existing file, all of it or nothing; it is there when this returns.
/// Throws RunError with the reason.
void append_text(const std::filesystem::path& file, const std::string& text);

}  // namespace dreampm
