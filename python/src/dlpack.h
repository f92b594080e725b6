// Capsules of DLPack (dmlc.github.io/dlpack, version 1.0): what nanobind leaves to the one who
// knows the streams, and the flags of an array.
#pragma once
#include <nanobind/ndarray.h>

#include <cstdint>
#include <memory>
#include <span>

namespace dreampm::python::dlpack {

namespace nb = nanobind;

/// The structs that a capsule points to; names of capsules that nobody has taken.
struct Managed {
  static constexpr const char* unused = "dltensor";
  nb::dlpack::dltensor tensor;
  void* manager_ctx;
  void (*deleter)(Managed*);
};
struct ManagedVersioned {
  static constexpr const char* unused = "dltensor_versioned";
  std::uint32_t major, minor;
  void* manager_ctx;
  void (*deleter)(ManagedVersioned*);
  std::uint64_t flags;
  nb::dlpack::dltensor tensor;
};
inline constexpr std::uint32_t version_major = 1, version_minor = 0;
inline constexpr std::uint64_t read_only = 1, is_copied = 2;  ///< flags of ManagedVersioned

/// Rows of numbers without gaps, of one or two axes.
struct Array {
  const void* data;
  nb::dlpack::device device;
  nb::dlpack::dtype type;
  std::span<const std::int64_t> shape;
  std::uint64_t flags;               ///< that only a versioned capsule can say
  std::shared_ptr<const void> keep;  ///< owns the data
};

/// A capsule that holds `keep` until its consumer, or where there is none the capsule itself, is
/// gone.
nb::object capsule(const Array& array, bool versioned);

}  // namespace dreampm::python::dlpack
