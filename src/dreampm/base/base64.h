// Bytes that are written as text.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace dreampm {

/// The bytes of base64 text up to its end, or up to `most` of them; blanks are passed over. The end
/// is what is no letter of it, as the padding is.
std::string base64_decoded(std::string_view text, std::size_t most = std::string::npos);

}  // namespace dreampm
