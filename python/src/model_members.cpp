#include "model_members.h"

namespace dreampm::python {

std::string quoted_words(std::span<const std::string_view> words) {
  std::string text;
  for (const std::string_view w : words) text += (text.empty() ? "'" : ", '") + std::string(w) + "'";
  return text;
}

void fail_member(const std::string& name, nb::handle given, const std::string& wanted) {
  constexpr std::size_t most = 60;
  std::string shown = nb::cast<std::string>(nb::repr(given));
  if (shown.size() > most) shown = shown.substr(0, most) + "...";
  throw nb::type_error((name + ": " + shown + ": must be " + wanted).c_str());
}

Values Member<Values>::from(nb::handle given, const std::string& name) {
  if (nb::isinstance<Values>(given)) return nb::cast<Values>(given);
  if (!nb::hasattr(given, "items")) throw nb::type_error((name + ": must be a dict of numbers").c_str());
  Values values;
  for (nb::handle item : given.attr("items")()) {
    double number = 0;
    const std::string key = nb::cast<std::string>(nb::str(item[0]));
    if (!nb::try_cast(item[1], number)) throw nb::type_error((name + "['" + key + "']: must be a number").c_str());
    values.set(key, number);
  }
  return values;
}

Box3d Member<Box3d>::from(nb::handle given, const std::string& name) {
  if (std::array<Vec3d, 2> corners; nb::try_cast(given, corners)) return {corners[0], corners[1]};
  throw nb::type_error((name + ": must be two corners, (min, max)").c_str());
}

void bind_values_by_key(nb::module_& m) {
  nb::class_<Values>(m, "Values", "Numbers by key. nan: the solver works it out.")
      .def(
          "__init__",
          [](Values* self, nb::handle values) { new (self) Values(Member<Values>::from(values, "Values")); },
          nb::arg("values") = nb::dict(),
          nb::sig("def __init__(self, values: Values | collections.abc.Mapping[str, float] = ...) -> None"))
      .def(
          "__getitem__",
          [](const Values& v, const std::string& key) {
            for (const auto& [name, value] : v)
              if (name == key) return value;
            throw nb::key_error(key.c_str());
          },
          nb::arg("key"))
      .def(
          "__setitem__", [](Values& v, const std::string& key, double value) { v.set(key, value); }, nb::arg("key"),
          nb::arg("value"))
      .def(
          "__delitem__", [](Values& v, const std::string& key) { v.erase(key); }, nb::arg("key"))
      .def(
          "__contains__",
          [](const Values& v, const std::string& key) {
            return std::any_of(v.begin(), v.end(), [&](const auto& one) { return one.first == key; });
          },
          nb::arg("key"))
      .def("__len__", [](const Values& v) { return std::distance(v.begin(), v.end()); })
      .def("keys",
           [](const Values& v) {
             std::vector<std::string> keys;
             for (const auto& [name, value] : v) keys.push_back(name);
             return keys;
           })
      .def(
          "__iter__", [](nb::handle self) { return nb::iter(self.attr("keys")()); },
          nb::sig("def __iter__(self) -> collections.abc.Iterator[str]"))
      .def("__repr__", [](nb::handle self) {
        nb::dict all;
        for (nb::handle key : self.attr("keys")()) all[key] = self[key];
        return nb::repr(all);
      });
}

}  // namespace dreampm::python
