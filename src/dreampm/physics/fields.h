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

/// The formula of a checked scene's field.
inline AnyField make_field(const model::ForceField& given) {
  AnyField field;
  Fields::for_each([&]<class F>() {
    if (F::name == given.type) field = with_members<F>(given.numbers, given.vectors);
  });
  return field;
}
/// Returns the field as a scene gives it, every value explicit; without its name and box.
inline model::ForceField as_model(const AnyField& field) {
  model::ForceField out;
  std::visit(
      [&]<class F>(const F& f) {
        out.type = F::name;
        for (const MemberParam<F>& p : F::params) {
          if (p.number) out.numbers.set(p.key, f.*p.number);
          if (p.vector) out.vectors.insert_or_assign(std::string(p.key), f.*p.vector);
        }
      },
      field);
  return out;
}

}  // namespace dreampm
