// Plain structs of C++ as classes of Python: each is given once, as a list of its members. A class
// takes its members by keyword or in their order, shows them, and has a signature with their types.
// A member that is a struct, a list or a dict is an object of Python, which the record refers to as
// any object of Python does; `value_of` makes the struct of C++ of them all.
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "convert.h"

namespace dreampm::python {

/// A struct as Python holds it.
template <class T>
struct Record {
  T value;        ///< but for the members that `held` has
  nb::dict held;  ///< objects of Python by the names of members
};

/// The words of an enum, by value. Specialized beside the structs that have them.
template <class E>
struct WordsOf;

/// "'slip', 'stick'": for messages and signatures.
std::string quoted_words(std::span<const std::string_view> words);
/// "NAME: 3: must be a list of Body"
[[noreturn]] void fail_member(const std::string& name, nb::handle given, const std::string& wanted);

/// The members of a struct that Python holds, which Struct fills in.
template <class T>
struct HeldMembers {
  struct One {
    std::string name;
    std::function<void(T&, nb::handle)> take;  ///< into the struct of C++
  };
  static std::vector<One>& list() {
    static std::vector<One> all;
    return all;
  }
};

template <class T>
T value_of(const Record<T>& record) {
  T value = record.value;
  for (const auto& member : HeldMembers<T>::list())
    if (record.held.contains(member.name.c_str())) member.take(value, record.held[member.name.c_str()]);
  return value;
}
template <class T>
nb::object record_of(T value) {
  return nb::cast(Record<T>{std::move(value), {}});
}

/// "Body": of a struct that is bound.
template <class T>
std::string class_name() {
  return nb::cast<std::string>(nb::type<Record<T>>().attr("__name__"));
}

/// How a member goes to Python and back: of a struct that is bound, unless specialized. `is_held`:
/// whether it is an object of Python.
template <class M>
struct Member {
  static constexpr bool is_held = true;
  static std::string type() { return class_name<M>(); }
  static M from(nb::handle given, const std::string& name) {
    if (!nb::isinstance<Record<M>>(given)) fail_member(name, given, "of type " + type());
    return value_of(nb::cast<const Record<M>&>(given));
  }
  static nb::object to(const M& member) { return record_of(member); }
  static nb::object kept(nb::handle given) { return nb::borrow(given); }
};

template <class M>
  requires std::is_arithmetic_v<M>
struct Member<M> {
  static constexpr bool is_held = false;
  static std::string type() { return std::is_same_v<M, bool> ? "bool" : std::is_integral_v<M> ? "int" : "float"; }
  static M from(nb::handle given, const std::string& name) {
    if (M value; nb::try_cast(given, value)) return value;
    fail_member(name, given, "of type " + type());
  }
  static nb::object to(M member) { return nb::cast(member); }
};
template <>
struct Member<std::string> {
  static constexpr bool is_held = false;
  static std::string type() { return "str"; }
  static std::string from(nb::handle given, const std::string& name) {
    if (std::string value; nb::try_cast(given, value)) return value;
    fail_member(name, given, "of type str");
  }
  static nb::object to(const std::string& member) { return nb::cast(member); }
};
template <>
struct Member<Vec3d> {
  static constexpr bool is_held = false;
  static std::string type() { return "numpy.typing.ArrayLike"; }
  static Vec3d from(nb::handle given, const std::string& name) {
    if (Vec3d v; nb::try_cast(given, v)) return v;
    throw nb::type_error(no_vector(given, name.c_str()).c_str());
  }
  static nb::object to(const Vec3d& member) { return nb::cast(member); }
};
template <class M>
  requires std::is_enum_v<M>
struct Member<M> {
  static constexpr bool is_held = false;
  static std::string type() { return "typing.Literal[" + quoted_words(WordsOf<M>::words) + "]"; }
  static M from(nb::handle given, const std::string& name) {
    if (std::string word; nb::try_cast(given, word))
      for (std::size_t i = 0; i < std::size(WordsOf<M>::words); ++i)
        if (WordsOf<M>::words[i] == word) return static_cast<M>(i);
    throw InputError(name + " is " + nb::cast<std::string>(nb::repr(given)) + ": must be one of " +
                     quoted_words(WordsOf<M>::words));
  }
  static nb::object to(M member) {
    const std::string_view word = WordsOf<M>::words[static_cast<std::size_t>(member)];
    return nb::str(word.data(), word.size());
  }
};
template <class M>
struct Member<std::optional<M>> {
  static constexpr bool is_held = Member<M>::is_held;
  static std::string type() { return Member<M>::type() + " | None"; }
  static std::optional<M> from(nb::handle given, const std::string& name) {
    if (given.is_none()) return std::nullopt;
    return Member<M>::from(given, name);
  }
  static nb::object to(const std::optional<M>& member) { return member ? Member<M>::to(*member) : nb::none(); }
  static nb::object kept(nb::handle given) { return given.is_none() ? nb::none() : Member<M>::kept(given); }
};
/// Structs as a list.
template <class M>
struct Member<std::vector<M>> {
  static constexpr bool is_held = true;
  static std::string type() { return "list[" + Member<M>::type() + "]"; }
  static std::vector<M> from(nb::handle given, const std::string& name) {
    if (!nb::isinstance<nb::list>(given) && !nb::isinstance<nb::tuple>(given))
      fail_member(name, given, "a list of " + Member<M>::type());
    std::vector<M> all;
    for (nb::handle one : given) all.push_back(Member<M>::from(one, name + "[" + std::to_string(all.size()) + "]"));
    return all;
  }
  static nb::object to(const std::vector<M>& member) {
    nb::list all;
    for (const M& one : member) all.append(Member<M>::to(one));
    return all;
  }
  static nb::object kept(nb::handle given) { return nb::list(nb::borrow(given)); }
};
/// Values by name as a dict.
template <class M, class Less>
struct Member<std::map<std::string, M, Less>> {
  static constexpr bool is_held = true;
  static std::string type() { return "dict[str, " + Member<M>::type() + "]"; }
  static std::map<std::string, M, Less> from(nb::handle given, const std::string& name) {
    if (!nb::isinstance<nb::dict>(given)) fail_member(name, given, "a dict of " + Member<M>::type());
    std::map<std::string, M, Less> all;
    for (auto [key, value] : nb::borrow<nb::dict>(given)) {
      const std::string word = nb::cast<std::string>(nb::str(key));
      all.insert_or_assign(word, Member<M>::from(value, name + "['" + word + "']"));
    }
    return all;
  }
  static nb::object to(const std::map<std::string, M, Less>& member) {
    nb::dict all;
    for (const auto& [key, value] : member) all[key.c_str()] = Member<M>::to(value);
    return all;
  }
  static nb::object kept(nb::handle given) { return given.attr("copy")(); }
};
/// One of several structs.
template <class... M>
struct Member<std::variant<M...>> {
  static constexpr bool is_held = true;
  static std::string type() {
    std::string names;
    ((names += (names.empty() ? "" : " | ") + class_name<M>()), ...);
    return names;
  }
  static std::variant<M...> from(nb::handle given, const std::string& name) {
    std::optional<std::variant<M...>> value;
    const auto look = [&]<class One>() {
      if (!value && nb::isinstance<Record<One>>(given)) value = value_of(nb::cast<const Record<One>&>(given));
    };
    (look.template operator()<M>(), ...);
    if (!value) fail_member(name, given, "a " + type());
    return *value;
  }
  static nb::object to(const std::variant<M...>& member) {
    return std::visit([](const auto& one) { return record_of(one); }, member);
  }
  static nb::object kept(nb::handle given) { return nb::borrow(given); }
};
/// Some of a fixed number, as a tuple: none can be added.
template <class M, std::size_t N>
struct Member<std::array<M, N>> {
  static constexpr bool is_held = Member<M>::is_held;
  static std::string type() { return "collections.abc.Sequence[" + Member<M>::type() + "]"; }
  static std::array<M, N> from(nb::handle given, const std::string& name) {
    if (!nb::hasattr(given, "__len__") || nb::len(given) != N)
      fail_member(name, given, std::to_string(N) + " of type " + Member<M>::type());
    std::array<M, N> all;
    for (std::size_t i = 0; i < N; ++i) all[i] = Member<M>::from(given[i], name + "[" + std::to_string(i) + "]");
    return all;
  }
  static nb::object to(const std::array<M, N>& member) {
    nb::list all;
    for (const M& one : member) all.append(Member<M>::to(one));
    return nb::tuple(all);
  }
  static nb::object kept(nb::handle given) { return nb::tuple(nb::borrow(given)); }
};
/// Names.
template <>
struct Member<std::vector<std::string>> {
  static constexpr bool is_held = true;
  static std::string type() { return "list[str]"; }
  static std::vector<std::string> from(nb::handle given, const std::string& name) {
    if (nb::isinstance<nb::str>(given)) fail_member(name, given, "a list of names");
    if (std::vector<std::string> names; nb::try_cast(given, names)) return names;
    fail_member(name, given, "a list of names");
  }
  static nb::object to(const std::vector<std::string>& member) { return nb::cast(member); }
  static nb::object kept(nb::handle given) { return nb::list(nb::borrow(given)); }
};

/// A struct as a class.
template <class T>
class Struct {
 public:
  Struct(nb::module_& module, const char* name, const std::string& doc)
      : name_(name), class_(module, name, doc.c_str()) {}

  template <class M>
  Struct& member(const char* name, M T::* at, const std::string& doc) {
    const std::string path = std::string(name_) + "." + name;
    One one{name, Member<M>::type(), {}, {}};
    if constexpr (Member<M>::is_held) {
      one.set = [=, key = one.name](Record<T>& self, nb::handle value) {
        Member<M>::from(value, path);  // it must be right
        self.held[key.c_str()] = Member<M>::kept(value);
      };
      one.get = [=, key = one.name](Record<T>& self) -> nb::object {
        if (!self.held.contains(key.c_str())) self.held[key.c_str()] = Member<M>::to(self.value.*at);
        return self.held[key.c_str()];
      };
      HeldMembers<T>::list().push_back({name, [=](T& to, nb::handle value) { to.*at = Member<M>::from(value, path); }});
    } else {
      one.set = [=](Record<T>& self, nb::handle value) { self.value.*at = Member<M>::from(value, path); };
      one.get = [=](Record<T>& self) { return Member<M>::to(self.value.*at); };
    }
    const std::string getter = "def " + one.name + "(self) -> " + shown_type<M>(),
                      setter = "def " + one.name + "(self, value: " + one.type + ") -> None";
    const std::size_t number = members_->size();
    members_->push_back(std::move(one));
    class_.def_prop_rw(
        name, [all = members_, number](Record<T>& self) { return (*all)[number].get(self); },
        [all = members_, number](Record<T>& self, nb::handle value) { (*all)[number].set(self, value); },
        nb::for_getter(nb::sig(keep(getter))), nb::for_setter(nb::sig(keep(setter))), nb::arg().none(), keep(doc));
    return *this;
  }

  /// Ends the list.
  void done() {
    std::string signature = "def __init__(self";
    for (const One& m : *members_) signature += ", " + m.name + ": " + m.type + " = ...";
    class_
        .def(
            "__init__",
            [all = members_, of = std::string(name_)](Record<T>* self, nb::args args, nb::kwargs given) {
              new (self) Record<T>{};
              fill(*self, *all, of, args, given);
            },
            nb::sig(keep(signature + ") -> None")))
        .def("__repr__", [all = members_, of = std::string(name_)](Record<T>& self) { return shown(self, *all, of); })
        .def("__copy__", [](const Record<T>& self) { return Record<T>{value_of(self), {}}; })
        .def(
            "__deepcopy__", [](const Record<T>& self, nb::handle) { return Record<T>{value_of(self), {}}; },
            nb::arg("memo"));
  }

 private:
  struct One {
    std::string name, type;
    std::function<void(Record<T>&, nb::handle)> set;
    std::function<nb::object(Record<T>&)> get;
  };
  static void fill(Record<T>& self, const std::vector<One>& all, const std::string& of, const nb::args& args,
                   const nb::kwargs& given) {
    if (args.size() > all.size()) throw nb::type_error((of + ": more values than members").c_str());
    for (std::size_t i = 0; i < args.size(); ++i) all[i].set(self, args[i]);
    for (auto [key, value] : given) {
      const std::string word = nb::cast<std::string>(key);
      const auto known = std::find_if(all.begin(), all.end(), [&](const One& m) { return m.name == word; });
      if (known == all.end()) {
        std::string names;
        for (const One& m : all) names += (names.empty() ? "" : ", ") + m.name;
        throw nb::type_error((of + " has no member '" + word + "'; it has " + names).c_str());
      }
      if (static_cast<std::size_t>(known - all.begin()) < args.size())
        throw nb::type_error((of + "." + word + " is given twice").c_str());
      known->set(self, value);
    }
  }
  /// Members that are not as usual.
  static std::string shown(Record<T>& self, const std::vector<One>& all, const std::string& of) {
    Record<T> usual{};
    std::string text;
    for (const One& m : all) {
      const std::string now = nb::cast<std::string>(nb::repr(m.get(self)));
      if (now != nb::cast<std::string>(nb::repr(m.get(usual)))) text += (text.empty() ? "" : ", ") + m.name + "=" + now;
    }
    return of + "(" + text + ")";
  }
  /// Returns the type as read, of one that may be given in several ways.
  template <class M>
  static std::string shown_type() {
    std::string type = Member<M>::type();
    const auto replace = [&](const std::string& from, const std::string& to) {
      if (const std::size_t at = type.find(from); at != std::string::npos) type.replace(at, from.size(), to);
    };
    replace("numpy.typing.ArrayLike", "tuple[float, float, float]");
    replace(" | dict[str, object] | str", ""), replace(" | collections.abc.Mapping[str, float]", "");
    if (type.starts_with("collections.abc.Sequence[")) {
      replace("collections.abc.Sequence[", "tuple[");
      type.insert(type.rfind(']'), ", ...");
    }
    return type;
  }
  /// Signatures and docs are kept as pointers.
  static const char* keep(const std::string& text) {
    static auto* const all = new std::vector<std::unique_ptr<const std::string>>;
    return all->emplace_back(std::make_unique<const std::string>(text))->c_str();
  }

  const char* name_;
  nb::class_<Record<T>> class_;
  std::shared_ptr<std::vector<One>> members_ = std::make_shared<std::vector<One>>();
};

}  // namespace dreampm::python
