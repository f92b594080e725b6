// HDF5 behind the archive and the time series of exchange/: types, reasons.
#pragma once
#include <hdf5.h>

#include <string>

#include "dreampm/base/hdf5_handle.h"
#include "dreampm/io/archive.h"

namespace dreampm {

template <ArchiveValue T>
hid_t h5_type() {
  if constexpr (std::is_same_v<T, float>) return H5T_IEEE_F32LE;
  if constexpr (std::is_same_v<T, double>) return H5T_IEEE_F64LE;
  if constexpr (std::is_same_v<T, std::int32_t>) return H5T_STD_I32LE;
  if constexpr (std::is_same_v<T, std::uint32_t>) return H5T_STD_U32LE;
  if constexpr (std::is_same_v<T, std::uint64_t>) return H5T_STD_U64LE;
  if constexpr (std::is_same_v<T, std::int64_t>) return H5T_STD_I64LE;
  if constexpr (std::is_same_v<T, std::uint8_t>) return H5T_STD_U8LE;
}

template <ArchiveValue T>
const char* h5_type_name() {
  if constexpr (std::is_same_v<T, float>) return "float";
  if constexpr (std::is_same_v<T, double>) return "double";
  if constexpr (std::is_same_v<T, std::int32_t>) return "int32";
  if constexpr (std::is_same_v<T, std::uint32_t>) return "uint32";
  if constexpr (std::is_same_v<T, std::uint64_t>) return "uint64";
  if constexpr (std::is_same_v<T, std::int64_t>) return "int64";
  if constexpr (std::is_same_v<T, std::uint8_t>) return "uint8";
}

/// UTF-8 text of this many bytes, padded with zeros.
H5Handle h5_text_type(std::size_t size);

/// The innermost reason on HDF5's error stack: the system's words if there are any.
std::string h5_reason();

/// Names of the attributes.
namespace archive_key {
inline constexpr const char* format = "format";
inline constexpr const char* version = "version";
inline constexpr const char* scene_hash = "scene_hash";
}  // namespace archive_key

}  // namespace dreampm
