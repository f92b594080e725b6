// Numbers as they lie in the files of other programs: of any type, in either byte order.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace dreampm {

/// One number at `bytes`; `swapped`: in the other byte order.
template <class T>
T raw_number(const char* bytes, bool swapped) {
  char own[sizeof(T)];
  for (std::size_t k = 0; k < sizeof own; ++k) own[k] = bytes[swapped ? sizeof own - 1 - k : k];
  T v;
  std::memcpy(&v, own, sizeof v);
  return v;
}

/// The representation of a number in a file.
struct NumberType {
  std::string_view name;  ///< as VTK's XML files have it: "Float32"
  std::size_t bytes = 0;  ///< of one
  double (*read)(const char* bytes, bool swapped);
};

template <class T>
double read_raw(const char* bytes, bool swapped) {
  return static_cast<double>(raw_number<T>(bytes, swapped));
}
template <class T>
constexpr NumberType number_type(std::string_view name) {
  return {name, sizeof(T), read_raw<T>};
}

inline constexpr NumberType number_types[]{number_type<std::int8_t>("Int8"),   number_type<std::uint8_t>("UInt8"),
                                           number_type<std::int16_t>("Int16"), number_type<std::uint16_t>("UInt16"),
                                           number_type<std::int32_t>("Int32"), number_type<std::uint32_t>("UInt32"),
                                           number_type<std::int64_t>("Int64"), number_type<std::uint64_t>("UInt64"),
                                           number_type<float>("Float32"),      number_type<double>("Float64")};

/// The type of that name, or null.
inline const NumberType* find_number_type(std::string_view name) {
  for (const NumberType& t : number_types)
    if (t.name == name) return &t;
  return nullptr;
}

}  // namespace dreampm
