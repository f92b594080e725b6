#include "convert.h"

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

SceneShape shape_of(nb::handle shape) {
  if (nb::isinstance<SceneShape>(shape)) return nb::cast<SceneShape>(shape);
  return SceneShape::yaml(yaml_of(shape));
}

std::string shown(nb::handle object, const char* name, const std::vector<const char*>& attributes) {
  std::string text = std::string(name) + "(";
  for (const char* a : attributes)
    text +=
        std::string(a == attributes.front() ? "" : ", ") + a + "=" + nb::cast<std::string>(nb::repr(object.attr(a)));
  return text + ")";
}

}  // namespace dreampm::python
