// Models of files: what their readers promise, and what is done with each.
#pragma once
#include "dreampm/geometry/alike.h"
#include "dreampm/geometry/model.h"
#include "one_input.h"

namespace dreampm::fuzz {

/// Gives the bytes to a reader of models.
template <class Parse>
void read_model_of(const std::uint8_t* data, std::size_t size, std::size_t factor, const Parse& parse) {
  read_one(size, factor, [&] {
    Model model = parse(text_of(data, size), std::string(input_name));
    require_finite(model, input_name);
    for (const auto& triangle : model.triangles)
      for (const std::uint32_t v : triangle)
        if (v >= model.vertices.size()) fail("a face names a vertex that is not there");
    for (const std::size_t n : {model.velocities.size(), model.ids.size(), model.colors.size()})
      if (n != 0 && n != model.vertices.size()) fail("a column is not as long as the others");
    if (model.vertices.empty()) return;
    turn_alike_with_warnings(model, input_name);
    enclosed_volume(model), surface_area(model);
  });
}

}  // namespace dreampm::fuzz
