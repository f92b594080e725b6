// Memory that is used again and again.
#pragma once
#include <cstddef>

namespace dreampm {

/// Resizes `v`; its contents are lost. Where its capacity is too small it reserves an eighth more
/// than it needs, so that growing matter rarely allocates.
template <class Vector>
void resize_for_overwrite(Vector& v, std::size_t size) {
  if (v.capacity() < size) {
    Vector().swap(v);
    v.reserve(size + size / 8);
  }
  v.resize(size);
}

}  // namespace dreampm
