#include "dreampm/base/base64.h"

#include <cstdint>

namespace dreampm {

std::string base64_decoded(std::string_view text, std::size_t most) {
  std::string out;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    int value = -1;
    if (c >= 'A' && c <= 'Z') value = c - 'A';
    if (c >= 'a' && c <= 'z') value = c - 'a' + 26;
    if (c >= '0' && c <= '9') value = c - '0' + 52;
    if (c == '+') value = 62;
    if (c == '/') value = 63;
    if (value < 0) {
      if (c == ' ' || c == '\n' || c == '\r' || c == '\t') continue;
      break;  // the padding, or the end
    }
    bits = bits << 6 | static_cast<std::uint32_t>(value);
    if ((count += 6) < 8) continue;
    count -= 8;
    out += static_cast<char>(bits >> count & 0xff);
    if (out.size() == most) break;
  }
  return out;
}

}  // namespace dreampm
