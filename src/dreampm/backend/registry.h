// The backends of the build, by name. A new one: its folder, and its line in registry.cpp.
#pragma once
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "dreampm/backend/backend.h"

namespace dreampm {

/// A backend in the precision that it computes in.
using AnyBackend = std::variant<std::unique_ptr<Backend<float>>, std::unique_ptr<Backend<double>>>;

/// A device that a backend would use, and bytes of its memory now.
struct DeviceFacts {
  std::string about;
  std::size_t free = 0, all = 0;
};

struct BackendInfo {
  std::string_view name;   ///< as the command and the library take it
  std::string_view about;  ///< a few words
  /// `isa`: an instruction set that it knows, or "auto". Throws InputError for another.
  AnyBackend (*make)(std::string_view isa);
  /// The reason why this machine cannot run it, or an empty text; null where every machine can.
  std::string (*why_not)() = nullptr;
  /// The device; null where the processor is all that it uses. Throws InputError where there is
  /// none.
  DeviceFacts (*device)() = nullptr;
};

/// All of them, the default first.
std::span<const BackendInfo> backends();
std::vector<std::string> backend_names();
/// Those that this machine can run.
std::vector<std::string> backends_here();
/// Throws InputError with the names that there are; an empty name means the default.
const BackendInfo& backend_info(std::string_view name);
/// True if the backend of that name computes on a device, and not on the processor alone.
inline bool has_device(std::string_view name) {
  for (const BackendInfo& b : backends())
    if (b.name == name) return b.device != nullptr;
  return false;
}
/// The backend of that name, as backend_info() takes it.
AnyBackend make_backend(std::string_view name, std::string_view isa = "auto");

}  // namespace dreampm
