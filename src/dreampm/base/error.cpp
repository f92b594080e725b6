#include "dreampm/base/error.h"

#include <cerrno>
#include <cstring>

namespace dreampm {

std::string system_reason() { return std::strerror(errno); }

}  // namespace dreampm
