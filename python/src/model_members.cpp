#include "model_members.h"

namespace dreampm::python {

std::string quoted_words(std::span<const std::string_view> words) {
  std::string text;
  for (const std::string_view w : words) text += (text.empty() ? "'" : ", '") + std::string(w) + "'";
  return text;
}

std::vector<std::string> Member<std::vector<std::string>>::from(nb::handle given, const std::string& name) {
  if (nb::isinstance<nb::str>(given)) throw nb::type_error((name + ": a list of names, not one").c_str());
  if (std::vector<std::string> names; nb::try_cast(given, names)) return names;
  throw nb::type_error((name + ": must be a list of names").c_str());
}
nb::object Member<std::vector<std::string>>::to(std::vector<std::string>& member, nb::handle) {
  return nb::tuple(nb::cast(member));
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

std::string Member<ProbeForm>::type() {
  return "HeightProbe | PressureProbe | VelocityProbe | FluxProbe | RegionProbe | ForceProbe | ExtentProbe | "
         "PointProbe | PoseProbe | InflowProbe";
}
namespace {
template <std::size_t N = 0>
ProbeForm form_from(nb::handle given, const std::string& name) {
  if constexpr (N == std::variant_size_v<ProbeForm>) {
    throw nb::type_error((name + ": must be a " + Member<ProbeForm>::type()).c_str());
  } else {
    using Form = std::variant_alternative_t<N, ProbeForm>;
    if (nb::isinstance<Form>(given)) return nb::cast<Form>(given);
    return form_from<N + 1>(given, name);
  }
}
}  // namespace
ProbeForm Member<ProbeForm>::from(nb::handle given, const std::string& name) { return form_from(given, name); }

std::array<Wall, 6> Member<std::array<Wall, 6>>::from(nb::handle given, const std::string& name) {
  if (std::array<Wall, 6> walls; nb::try_cast(given, walls)) return walls;
  throw nb::type_error((name + ": must be six walls: x_min, x_max, y_min, y_max, z_min, z_max").c_str());
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
