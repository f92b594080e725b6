// How errors are thrown: with a formatted text. The classes stand in the public header.
#pragma once
#include <fmt/format.h>

#include <string>
#include <utility>

#include "dreampm/error.h"

namespace dreampm {

template <class... Args>
[[noreturn]] void fail_input(fmt::format_string<Args...> text, Args&&... args) {
  throw InputError(fmt::format(text, std::forward<Args>(args)...));
}
template <class... Args>
[[noreturn]] void fail_run(fmt::format_string<Args...> text, Args&&... args) {
  throw RunError(fmt::format(text, std::forward<Args>(args)...));
}

/// The text of errno, for messages about files.
std::string system_reason();

}  // namespace dreampm
