// The one list of force fields. A new one: its file in fields/, and its name here.
#pragma once
#include <utility>
#include <variant>

#include "dreampm/physics/fields/attractor.h"
#include "dreampm/physics/fields/brush.h"
#include "dreampm/physics/fields/drag.h"
#include "dreampm/physics/fields/wind.h"

namespace dreampm {

template <class... F>
struct FieldList {
  using Any = std::variant<F...>;
  template <class R>
  using Step = std::variant<typename F::template Step<R>...>;

  /// Calls f.template operator()<F>() for each type in order.
  template <class Call>
  static void for_each(Call&& f) {
    (f.template operator()<F>(), ...);
  }
  template <class R>
  static Step<R> step(const Any& any, double dt) {
    return std::visit(
        [&]<class One>(const One& f) {
          return Step<R>(std::in_place_type<typename One::template Step<R>>, One::template Step<R>::of(f, dt));
        },
        any);
  }
};

using Fields = FieldList<Drag, Wind, Attractor, Brush>;
using AnyField = Fields::Any;

}  // namespace dreampm
