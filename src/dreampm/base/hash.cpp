#include "dreampm/base/hash.h"

#include <fmt/format.h>

#include <cstring>

namespace dreampm {

void Hash64::bytes(const void* data, std::size_t size) {
  const auto* p = static_cast<const unsigned char*>(data);
  length_ += size;
  for (; size >= 8; p += 8, size -= 8) {
    std::uint64_t word;
    std::memcpy(&word, p, 8);
    a_ = mix64(a_ ^ word) + 0x9e3779b97f4a7c15ull;
  }
  if (size) {
    std::uint64_t word = 0;
    std::memcpy(&word, p, size);
    a_ = mix64(a_ ^ word ^ (static_cast<std::uint64_t>(size) << 56)) + 0x9e3779b97f4a7c15ull;
  }
}

std::uint64_t Hash64::value() const { return mix64(a_ ^ length_); }

std::string Hash64::hex() const { return fmt::format("{:016x}", value()); }

}  // namespace dreampm
