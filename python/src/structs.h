// Plain structs of C++ as classes of Python: each is given once, as a list of its members. A class
// takes its members by keyword or in their order, shows them, compares them, and has a signature
// with their types.
#pragma once
#include <nanobind/stl/bind_map.h>
#include <nanobind/stl/bind_vector.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "convert.h"

namespace dreampm::python {

/// The words of an enum, by value. Specialized beside the structs that have them.
template <class E>
struct WordsOf;

/// "'slip', 'stick'": for messages and signatures.
std::string quoted_words(std::span<const std::string_view> words);

template <class M>
struct IsOptional : std::false_type {};
template <class T>
struct IsOptional<std::optional<T>> : std::true_type {
  using Value = T;
};

/// How a member goes to Python and back. `parent` holds what is shown in place.
template <class M>
struct Member {
  static std::string type() {
    if constexpr (IsOptional<M>::value)
      return Member<typename IsOptional<M>::Value>::type() + " | None";
    else if constexpr (std::is_enum_v<M>)
      return "typing.Literal[" + quoted_words(WordsOf<M>::words) + "]";
    else if constexpr (std::is_same_v<M, bool>)
      return "bool";
    else if constexpr (std::is_integral_v<M>)
      return "int";
    else if constexpr (std::is_floating_point_v<M>)
      return "float";
    else if constexpr (std::is_same_v<M, std::string>)
      return "str";
    else if constexpr (std::is_same_v<M, Vec3d>)
      return "numpy.typing.ArrayLike";
    else
      return nb::cast<std::string>(nb::type<M>().attr("__name__"));
  }
  static M from(nb::handle given, const std::string& name) {
    const auto wrong = [&](const std::string& wanted) {
      const std::string shown = nb::cast<std::string>(nb::repr(given));
      throw nb::type_error(
          (name + ": " + (shown.size() > 60 ? shown.substr(0, 60) + "..." : shown) + ": must be " + wanted).c_str());
    };
    if constexpr (IsOptional<M>::value) {
      if (given.is_none()) return std::nullopt;
      return Member<typename IsOptional<M>::Value>::from(given, name);
    } else if constexpr (std::is_enum_v<M>) {
      std::string word;
      if (nb::try_cast(given, word))
        for (std::size_t i = 0; i < std::size(WordsOf<M>::words); ++i)
          if (WordsOf<M>::words[i] == word) return static_cast<M>(i);
      throw InputError(name + " is " + nb::cast<std::string>(nb::repr(given)) + ": must be one of " +
                       quoted_words(WordsOf<M>::words));
    } else if constexpr (std::is_same_v<M, Vec3d>) {
      if (Vec3d v; nb::try_cast(given, v)) return v;
      throw nb::type_error(no_vector(given, name.c_str()).c_str());
    } else {
      if constexpr (std::is_class_v<M> && !std::is_same_v<M, std::string>) {
        if (M value; nb::try_cast(given, value)) return value;
      } else if (M value; nb::try_cast(given, value)) {
        return value;
      }
      wrong("of type " + type());
    }
    return M{};
  }
  static nb::object to(M& member, nb::handle parent) {
    if constexpr (IsOptional<M>::value) {
      if (!member) return nb::none();
      return Member<typename IsOptional<M>::Value>::to(*member, parent);
    } else if constexpr (std::is_enum_v<M>) {
      const std::string_view word = WordsOf<M>::words[static_cast<std::size_t>(member)];
      return nb::str(word.data(), word.size());
    } else if constexpr (std::is_class_v<M> && !std::is_same_v<M, std::string> && !std::is_same_v<M, Vec3d>) {
      return nb::cast(member, nb::rv_policy::reference_internal, parent);
    } else {
      return nb::cast(member);
    }
  }
};

/// Lists of names are tuples: what is appended to a copy would be lost.
template <>
struct Member<std::vector<std::string>> {
  static std::string type() { return "collections.abc.Sequence[str]"; }
  static std::vector<std::string> from(nb::handle given, const std::string& name);
  static nb::object to(std::vector<std::string>& member, nb::handle);
};
template <std::size_t N>
struct Member<std::array<bool, N>> {
  static std::string type() { return "collections.abc.Sequence[bool]"; }
  static std::array<bool, N> from(nb::handle given, const std::string& name) {
    if (std::array<bool, N> value; nb::try_cast(given, value)) return value;
    throw nb::type_error((name + ": must be " + std::to_string(N) + " of True or False").c_str());
  }
  static nb::object to(std::array<bool, N>& member, nb::handle) { return nb::tuple(nb::cast(member)); }
};

/// A struct as a class.
template <class T>
class Struct {
 public:
  Struct(nb::module_& module, const char* name, const std::string& doc)
      : name_(name), class_(module, name, doc.c_str()) {}

  template <class M>
  Struct& member(const char* name, M T::* at, const std::string& doc) {
    members_->push_back({name, Member<M>::type(),
                         [=, of = std::string(name_) + "." + name](T& self, nb::handle value) {
                           self.*at = Member<M>::from(value, of);
                         },
                         [=](T& self, nb::handle parent) { return Member<M>::to(self.*at, parent); }});
    const std::size_t number = members_->size() - 1;
    class_.def_prop_rw(
        name,
        [members = members_, number](nb::handle self) { return (*members)[number].get(nb::cast<T&>(self), self); },
        [members = members_, number](nb::handle self, nb::handle value) {
          (*members)[number].set(nb::cast<T&>(self), value);
        },
        nb::for_getter(nb::sig(keep("def " + std::string(name) + "(self) -> " + getter_type<M>()))),
        nb::for_setter(nb::sig(keep("def " + std::string(name) + "(self, value: " + Member<M>::type() + ") -> None"))),
        keep(doc));
    return *this;
  }

  /// Ends the list.
  nb::class_<T>& done() {
    std::string signature = "def __init__(self";
    for (const One& m : *members_) signature += ", " + m.name + ": " + m.type + " = ...";
    class_
        .def(
            "__init__",
            [members = members_, of = std::string(name_)](nb::handle self, nb::args args, nb::kwargs given) {
              T* made = new (nb::inst_ptr<T>(self)) T{};
              nb::inst_mark_ready(self);
              if (args.size() > members->size()) throw nb::type_error((of + ": more values than members").c_str());
              for (std::size_t i = 0; i < args.size(); ++i) (*members)[i].set(*made, args[i]);
              for (auto [key, value] : given) {
                const std::string word = nb::cast<std::string>(key);
                const auto known =
                    std::find_if(members->begin(), members->end(), [&](const One& m) { return m.name == word; });
                if (known == members->end()) {
                  std::string names;
                  for (const One& m : *members) names += (names.empty() ? "" : ", ") + m.name;
                  throw nb::type_error((of + " has no member '" + word + "'; it has " + names).c_str());
                }
                if (static_cast<std::size_t>(known - members->begin()) < args.size())
                  throw nb::type_error((of + "." + word + " is given twice").c_str());
                known->set(*made, value);
              }
            },
            nb::sig(keep(signature + ") -> None")))
        .def("__repr__",
             [members = members_, of = std::string(name_)](nb::handle self) {
               std::string text;
               for (const One& m : *members) {
                 const std::string now = nb::cast<std::string>(nb::repr(m.get(nb::cast<T&>(self), self)));
                 const nb::object usual = nb::cast(T{});
                 if (now == nb::cast<std::string>(nb::repr(m.get(nb::cast<T&>(usual), usual)))) continue;
                 text += (text.empty() ? "" : ", ") + m.name + "=" + now;
               }
               return of + "(" + text + ")";
             })
        .def("__copy__", [](const T& self) { return T(self); })
        .def("__deepcopy__", [](const T& self, nb::handle) { return T(self); }, nb::arg("memo"));
    return class_;
  }

 private:
  struct One {
    std::string name, type;
    std::function<void(T&, nb::handle)> set;
    std::function<nb::object(T&, nb::handle)> get;
  };
  template <class M>
  static std::string getter_type() {
    std::string type = Member<M>::type();
    const std::string vector = "numpy.typing.ArrayLike";
    if (const std::size_t at = type.find(vector); at != std::string::npos)
      type.replace(at, vector.size(), "tuple[float, float, float]");
    const std::string sequence = "collections.abc.Sequence[";
    if (const std::size_t at = type.find(sequence); at != std::string::npos)
      type.replace(at, sequence.size(), "tuple["), type.insert(type.rfind(']'), ", ...");
    return type;
  }
  /// Signatures and docs are kept as pointers.
  static const char* keep(const std::string& text) {
    static auto* const all = new std::vector<std::unique_ptr<const std::string>>;
    return all->emplace_back(std::make_unique<const std::string>(text))->c_str();
  }

  const char* name_;
  nb::class_<T> class_;
  std::shared_ptr<std::vector<One>> members_ = std::make_shared<std::vector<One>>();
};

}  // namespace dreampm::python
