#include "convert.h"

#include <nanobind/ndarray.h>

namespace dreampm::python {
namespace {

nb::object plain(nb::handle value) {
  if (nb::hasattr(value, "tolist")) return value.attr("tolist")();
  if (nb::hasattr(value, "__fspath__")) return value.attr("__fspath__")();
  const std::string type = nb::cast<std::string>(value.type().attr("__name__"));
  throw nb::type_error(
      ("a " + type + " has no place in a scene: numbers, bools, strings, lists, dicts and arrays have").c_str());
}

}  // namespace

std::string yaml_of(nb::handle value) {
  if (nb::isinstance<nb::str>(value)) return nb::cast<std::string>(value);
  const nb::object dumps = nb::module_::import_("json").attr("dumps");
  return nb::cast<std::string>(
      dumps(value, nb::arg("ensure_ascii") = false, nb::arg("default") = nb::cpp_function(plain)));
}

std::vector<std::string> set_words(nb::handle set) {
  std::vector<std::string> words;
  if (set.is_none()) return words;
  if (nb::hasattr(set, "items")) {
    for (nb::handle item : set.attr("items")())
      words.push_back(nb::cast<std::string>(nb::str(item[0])) + "=" + yaml_of(item[1]));
    return words;
  }
  if (nb::isinstance<nb::str>(set))
    throw nb::type_error("set: a dict {'space.spacing': 0.01}, or a list of 'PATH=VALUE'");
  for (nb::handle word : set) words.push_back(nb::cast<std::string>(word));
  return words;
}

std::string no_vector(nb::handle source, const char* name) noexcept {
  std::string shown = "what was given";
  if (PyObject* text = PyObject_Repr(source.ptr())) {
    if (const char* utf8 = PyUnicode_AsUTF8AndSize(text, nullptr)) shown = utf8;
    Py_DECREF(text);
  }
  PyErr_Clear();
  constexpr std::size_t most = 60;
  if (shown.size() > most) shown = shown.substr(0, most) + "...";
  return std::string(name) + ": " + shown + " is no vector, which is three numbers: (x, y, z)";
}

std::vector<Vec3d> points_of(nb::handle points, const char* name) {
  const auto refuse = [&](const std::string& what) {
    throw nb::type_error((std::string(name) + ": " + what + ": points are of shape (n, 3)").c_str());
  };
  nb::object array;
  try {
    array = nb::module_::import_("numpy").attr("ascontiguousarray")(points, "float64");
  } catch (nb::python_error& e) {
    if (!e.matches(PyExc_ValueError) && !e.matches(PyExc_TypeError)) throw;
    refuse("rows of other lengths than 3, or no numbers");
  }
  using Places = nb::ndarray<const double, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
  Places places;
  if (nb::len(array) == 0) return {};
  if (!nb::try_cast(array, places)) refuse("shape " + nb::cast<std::string>(nb::repr(array.attr("shape"))));
  std::vector<Vec3d> all(places.shape(0));
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double* p = places.data() + 3 * i;
    all[i] = {p[0], p[1], p[2]};
  }
  return all;
}

Shape shape_of(nb::handle shape) {
  if (nb::isinstance<Shape>(shape)) return nb::cast<Shape>(shape);
  return parse_shape(yaml_of(shape));
}

std::string shown(nb::handle object, const char* name, const std::vector<const char*>& attributes) {
  std::string text = std::string(name) + "(";
  for (const char* a : attributes)
    text +=
        std::string(a == attributes.front() ? "" : ", ") + a + "=" + nb::cast<std::string>(nb::repr(object.attr(a)));
  return text + ")";
}

}  // namespace dreampm::python
