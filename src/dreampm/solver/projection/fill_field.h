// Arrays over the rows of a grid, filled anew.
#pragma once
#include <algorithm>
#include <cstddef>

#include "dreampm/base/parallel.h"
#include "dreampm/state/resize_for_overwrite.h"

namespace dreampm {

/// Makes `field` an array of `size` equal values; keeps its memory.
template <class Field>
void fill_field(Field& field, std::size_t size, typename Field::value_type value) {
  resize_for_overwrite(field, size);
  parallel_ranges(size, 1 << 14, [&](std::size_t begin, std::size_t end) {
    std::fill(field.begin() + static_cast<std::ptrdiff_t>(begin), field.begin() + static_cast<std::ptrdiff_t>(end),
              value);
  });
}

}  // namespace dreampm
