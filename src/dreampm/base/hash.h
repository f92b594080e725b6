// A 64-bit hash of bytes for identities (state, scene), not for security. Equal on every
// little-endian machine.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace dreampm {

/// Feed values in a fixed order; `value()` at any time.
class Hash64 {
 public:
  void bytes(const void* data, std::size_t size);
  template <class T>
    requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void add(T v) {
    bytes(&v, sizeof v);
  }
  template <class T>
    requires std::is_arithmetic_v<T>
  void add(std::span<const T> v) {
    add(static_cast<std::uint64_t>(v.size()));
    bytes(v.data(), v.size_bytes());
  }
  void add(std::string_view s) {
    add(static_cast<std::uint64_t>(s.size()));
    bytes(s.data(), s.size());
  }
  std::uint64_t value() const;
  /// 16 hexadecimal digits.
  std::string hex() const;

 private:
  std::uint64_t a_ = 0x9e3779b97f4a7c15ull;
  std::uint64_t length_ = 0;
};

/// Mixes one 64-bit word well (Stafford's variant 13 of the murmur3 finalizer, as in SplitMix64).
constexpr std::uint64_t mix64(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

}  // namespace dreampm
