#include "dreampm/base/uri.h"

#include <charconv>

namespace dreampm {

std::string percent_decoded(std::string_view uri) {
  std::string out;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    unsigned value = 0;
    const char *const digits = uri.data() + i + 1, *const end = digits + 2;
    if (uri[i] == '%' && i + 2 < uri.size() && std::from_chars(digits, end, value, 16).ptr == end) {
      out += static_cast<char>(value);
      i += 2;
    } else {
      out += uri[i];
    }
  }
  return out;
}

}  // namespace dreampm
