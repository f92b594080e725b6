// The kinds of shapes that Bullet has forms of; all others are met as meshes.
#pragma once
#include <type_traits>

#include "dreampm/shape.h"

namespace dreampm {

template <class Form>
inline constexpr bool is_exact_form = std::is_same_v<Form, BoxShape> || std::is_same_v<Form, SphereShape> ||
                                      std::is_same_v<Form, CylinderShape> || std::is_same_v<Form, PlaneShape>;

inline bool has_exact_form(const Shape& shape) {
  return std::visit([]<class Form>(const Form&) { return is_exact_form<Form>; }, shape.form);
}

}  // namespace dreampm
