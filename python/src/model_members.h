// How the members of the model go to Python and back. Everything that binds them includes this, so
// that lists are shown in place everywhere: what is appended to one is in the scene.
#pragma once
#include "dreampm/model/scene.h"
#include "structs.h"

namespace dreampm::python {

using VectorsByKey = decltype(model::ForceField::vectors);
using LooksByName = decltype(model::Render::looks);

}  // namespace dreampm::python

NB_MAKE_OPAQUE(std::vector<dreampm::Key<double>>)
NB_MAKE_OPAQUE(std::vector<dreampm::Key<dreampm::Vec3d>>)
NB_MAKE_OPAQUE(std::vector<dreampm::PoseKey>)
NB_MAKE_OPAQUE(std::vector<dreampm::model::Material>)
NB_MAKE_OPAQUE(std::vector<dreampm::model::Body>)
NB_MAKE_OPAQUE(std::vector<dreampm::model::Collider>)
NB_MAKE_OPAQUE(std::vector<dreampm::model::Emitter>)
NB_MAKE_OPAQUE(std::vector<dreampm::model::Sink>)
NB_MAKE_OPAQUE(std::vector<dreampm::model::ForceField>)
NB_MAKE_OPAQUE(std::vector<dreampm::model::Probe>)
NB_MAKE_OPAQUE(dreampm::python::VectorsByKey)
NB_MAKE_OPAQUE(dreampm::python::LooksByName)

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
  static constexpr std::array<std::string_view, 2> words{"clear", "studio"};
};
template <>
struct WordsOf<model::SurfaceFormat> {
  static constexpr std::array<std::string_view, 3> words{"ply", "obj", "vdb"};
};
template <>
struct WordsOf<model::LookType> {
  static constexpr std::array<std::string_view, 6> words{"dielectric", "opaque", "spheres", "wood", "metal", "plastic"};
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
  static std::string type() { return "Values | collections.abc.Mapping[str, float]"; }
  static Values from(nb::handle given, const std::string& name);
  static nb::object to(Values& member, nb::handle parent) {
    return nb::cast(member, nb::rv_policy::reference_internal, parent);
  }
};
/// A Shape, a dict as scene files have it behind `shape:`, or its text.
template <>
struct Member<Shape> {
  static std::string type() { return "_dreampm.Shape | dict[str, object] | str"; }
  static Shape from(nb::handle given, const std::string&) { return shape_of(given); }
  static nb::object to(Shape& member, nb::handle) { return nb::cast(member, nb::rv_policy::copy); }
};
template <>
struct Member<ProbeForm> {
  static std::string type();
  static ProbeForm from(nb::handle given, const std::string& name);
  static nb::object to(ProbeForm& member, nb::handle parent) {
    return std::visit([&](auto& form) { return nb::cast(form, nb::rv_policy::reference_internal, parent); }, member);
  }
};
template <>
struct Member<std::array<Wall, 6>> {
  static std::string type() { return "collections.abc.Sequence[Wall]"; }
  static std::array<Wall, 6> from(nb::handle given, const std::string& name);
  static nb::object to(std::array<Wall, 6>& member, nb::handle parent) {
    nb::list walls;
    for (Wall& wall : member) walls.append(nb::cast(wall, nb::rv_policy::reference_internal, parent));
    return nb::tuple(walls);
  }
};
/// Corners: (min, max).
template <>
struct Member<Box3d> {
  static std::string type() { return "collections.abc.Sequence[numpy.typing.ArrayLike]"; }
  static Box3d from(nb::handle given, const std::string& name);
  static nb::object to(Box3d& member, nb::handle) { return nb::make_tuple(member.min, member.max); }
};

/// The class Values.
void bind_values_by_key(nb::module_& module);

}  // namespace dreampm::python
