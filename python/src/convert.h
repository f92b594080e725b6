// Values of Python and of the library: vectors are sequences of three numbers and come back as
// tuples, shapes and values of scenes may be written as dicts.
#pragma once
#include <nanobind/nanobind.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/vector.h>

#include <array>
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

/// A value as scene files write it: a str as it stands, anything else as JSON, which is YAML.
/// Arrays of numpy become lists, paths text.
std::string yaml_of(nb::handle value);

/// PATH=VALUE of each item of a dict, or the words of a list as they stand; none of None.
std::vector<std::string> set_words(nb::handle set);

/// A Shape, a dict as scene files have it behind `shape:`, or its text.
SceneShape shape_of(nb::handle shape);

/// "Name(a=1, b=2)" of the attributes named.
std::string shown(nb::handle object, const char* name, const std::vector<const char*>& attributes);

}  // namespace dreampm::python
