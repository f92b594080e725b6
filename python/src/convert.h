// Values of Python and of the library: vectors are sequences of three numbers and come back as
// tuples, shapes and values of scenes may be written as dicts.
#pragma once
#include <nanobind/nanobind.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "dreampm/simulation.h"

namespace nanobind::detail {

template <>
struct type_caster<dreampm::Vec3d> {
  NB_TYPE_CASTER(dreampm::Vec3d, io_name("numpy.typing.ArrayLike", "tuple[float, float, float]"))

  bool from_python(handle source, std::uint32_t flags, cleanup_list* cleanup) noexcept {
    make_caster<std::array<double, 3>> three;
    if (!three.from_python(source, flags, cleanup)) return false;
    value = {three.value[0], three.value[1], three.value[2]};
    return true;
  }
  static handle from_cpp(const dreampm::Vec3d& v, rv_policy, cleanup_list*) noexcept {
    return Py_BuildValue("(ddd)", v.x, v.y, v.z);
  }
};

}  // namespace nanobind::detail

namespace dreampm::python {

namespace nb = nanobind;

/// The name of an argument, as a parameter of a template.
template <std::size_t N>
struct ArgumentName {
  char text[N];
  constexpr ArgumentName(const char (&from)[N]) { std::copy_n(from, N, text); }
};

/// "NAME: (0, -9.81) is no vector, which is three numbers: (x, y, z)"
std::string no_vector(nb::handle source, const char* name) noexcept;

/// An argument of that name, which becomes a vector. What is none raises a TypeError that names it:
/// nanobind itself would only list what the function takes.
template <ArgumentName Name>
class Vector {
 public:
  bool read(nb::handle source, std::uint32_t flags, nb::detail::cleanup_list* cleanup) noexcept {
    nb::detail::make_caster<Vec3d> caster;
    // Also whole numbers, at once: there is no other meaning that they could have.
    const auto free = static_cast<std::uint32_t>(nb::detail::cast_flags::convert);
    if (caster.from_python(source, flags | free, cleanup))
      vector_ = caster.value;
    else
      wrong_ = no_vector(source, Name.text);
    return true;
  }
  operator Vec3d() const {
    if (!wrong_.empty()) throw nb::type_error(wrong_.c_str());
    return vector_;
  }

 private:
  Vec3d vector_{};
  std::string wrong_;
};
/// The same of one that may be missing.
template <ArgumentName Name>
std::optional<Vec3d> given(const std::optional<Vector<Name>>& vector) {
  return vector ? std::optional<Vec3d>(*vector) : std::nullopt;
}

/// Points, (n, 3), of an array or a list of points. Raises TypeError with the shape that it has.
std::vector<Vec3d> points_of(nb::handle points, const char* name);

}  // namespace dreampm::python

namespace nanobind::detail {

template <dreampm::python::ArgumentName Called>
struct type_caster<dreampm::python::Vector<Called>> {
  NB_TYPE_CASTER(dreampm::python::Vector<Called>, io_name("numpy.typing.ArrayLike", "tuple[float, float, float]"))

  bool from_python(handle source, std::uint32_t flags, cleanup_list* cleanup) noexcept {
    return value.read(source, flags, cleanup);
  }
};

}  // namespace nanobind::detail

namespace dreampm::python {

/// A value as scene files write it: a str as it stands, anything else as JSON, which is YAML.
/// Arrays of numpy become lists, paths text.
std::string yaml_of(nb::handle value);

/// PATH=VALUE of each item of a dict, or the words of a list as they stand; none of None.
std::vector<std::string> set_words(nb::handle set);

/// A Shape, a dict as scene files have it behind `shape:`, or its text.
Shape shape_of(nb::handle shape);

/// "Name(a=1, b=2)" of the attributes named.
std::string shown(nb::handle object, const char* name, const std::vector<const char*>& attributes);
/// Gives a class such a __repr__.
template <class C>
void show(C& bound, const char* name, std::vector<const char*> attributes) {
  bound.def("__repr__", [=](nb::handle self) { return shown(self, name, attributes); });
}

}  // namespace dreampm::python
