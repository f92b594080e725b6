#include "dreampm/base/replacement.h"

#include <system_error>
#include <utility>

#include "dreampm/base/error.h"

namespace dreampm {

Replacement::Replacement(std::filesystem::path target) : target_(std::move(target)), temporary_(target_) {
  temporary_ += ".part";
}

Replacement::~Replacement() {
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
}

void Replacement::commit() {
  std::error_code ec;
  std::filesystem::rename(temporary_, target_, ec);
  if (ec) fail_run("{}: cannot be written: {}", target_.string(), ec.message());
}

}  // namespace dreampm
