// Memory that is used again and again.
#pragma once
#include <cstddef>

namespace dreampm {

/// Makes `v` so long; what it holds is lost. Where its memory is too small it takes an eighth more than it needs, so
/// that spreading matter rarely asks for any.
template <class Vector>
void refit(Vector& v, std::size_t size) {
  if (v.capacity() < size) {
    Vector().swap(v);
    v.reserve(size + size / 8);
  }
  v.resize(size);
}

}  // namespace dreampm
