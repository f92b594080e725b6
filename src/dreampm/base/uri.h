// Names of files that are written as URIs.
#pragma once
#include <string>
#include <string_view>

namespace dreampm {

/// The text of a URI with its escapes (%20) replaced by what they stand for.
std::string percent_decoded(std::string_view uri);

}  // namespace dreampm
