// How the members of the model go to Python and back, beside what structs.h says of all.
#pragma once
#include "dreampm/model/scene.h"
#include "structs.h"

namespace dreampm::python {

template <>
struct WordsOf<WallType> {
  static constexpr auto words = wall_type_names;
};
template <>
struct WordsOf<SolverKind> {
  static constexpr std::array<std::string_view, 2> words{"explicit", "projection"};
};
template <>
struct WordsOf<Pattern> {
  static constexpr std::array<std::string_view, 3> words{"jitter", "lattice", "poisson"};
};
template <>
struct WordsOf<SkyKind> {
  static constexpr std::array<std::string_view, 3> words{"clear", "studio", "night"};
};
template <>
struct WordsOf<model::SurfaceFormat> {
  static constexpr std::array<std::string_view, 3> words{"ply", "obj", "vdb"};
};
template <>
struct WordsOf<model::PictureFormat> {
  static constexpr std::array<std::string_view, 2> words{"png", "exr"};
};
template <>
struct WordsOf<model::LookType> {
  static constexpr auto words = model::look_type_names;
};
template <>
struct WordsOf<model::Place> {
  static constexpr std::array<std::string_view, 3> words{"terrace", "studio", "night"};
};
template <>
struct WordsOf<model::Floor> {
  static constexpr std::array<std::string_view, 2> words{"tiles", "none"};
};
template <>
struct WordsOf<model::Basin> {
  static constexpr std::array<std::string_view, 2> words{"glass", "none"};
};

/// Numbers by key, of which a dict makes some.
template <>
struct Member<Values> {
  static constexpr bool is_held = true;
  static std::string type() { return "Values | collections.abc.Mapping[str, float]"; }
  static Values from(nb::handle given, const std::string& name);
  static nb::object to(const Values& member) { return nb::cast(member); }
  static nb::object kept(nb::handle given) {
    return nb::isinstance<Values>(given) ? nb::borrow(given) : nb::cast(from(given, "values"));
  }
};
/// A Shape, a dict as scene files have it behind `shape:`, or its text.
template <>
struct Member<Shape> {
  static constexpr bool is_held = false;
  static std::string type() { return "Shape | dict[str, object] | str"; }
  static Shape from(nb::handle given, const std::string&) { return shape_of(given); }
  static nb::object to(const Shape& member) { return nb::cast(member); }
};
/// Corners: (min, max).
template <>
struct Member<Box3d> {
  static constexpr bool is_held = false;
  static std::string type() { return "collections.abc.Sequence[numpy.typing.ArrayLike]"; }
  static Box3d from(nb::handle given, const std::string& name);
  static nb::object to(const Box3d& member) { return nb::make_tuple(member.min, member.max); }
};

/// The class Values.
void bind_values_by_key(nb::module_& module);

}  // namespace dreampm::python
