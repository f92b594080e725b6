// fields: what acts on matter from afar. Each type's keys come from its own table
// (physics/field.h).
#include "dreampm/physics/fields.h"
#include "dreampm/scene/sections.h"

namespace dreampm::scene {
namespace {

const Schema<Box3d>& box_schema() {
  static const Schema<Box3d> schema{vector("min", &Box3d::min, any_number("m")).must().says("The low corner."),
                                    vector("max", &Box3d::max, any_number("m")).must().says("The high corner.")};
  return schema;
}

template <class F>
struct FieldDraft {
  F field;
  std::optional<Box3d> box;
};

template <class F>
Field<FieldDraft<F>> param(const MemberParam<F>& p) {
  using T = FieldDraft<F>;
  const Range range{p.min, p.max, p.above, false, p.unit};
  Field<T> f;
  f.key = std::string(p.key);
  f.required = p.required;
  if (p.number) {
    f.read = [member = p.number, range](Reading& in, const YamlNode& n, const std::string& path, T& out) {
      if (auto v = read_number(in.problems, n, path, range)) out.field.*member = *v;
    };
    f.write = [member = p.number](const T& t, const std::string& k, YamlNode& map) {
      map.put(k, write_number(t.field.*member));
    };
  } else {
    f.read = [member = p.vector, range](Reading& in, const YamlNode& n, const std::string& path, T& out) {
      if (auto v = read_vector(in.problems, n, path, range)) out.field.*member = *v;
    };
    f.write = [member = p.vector](const T& t, const std::string& k, YamlNode& map) {
      map.put(k, write_vector(t.field.*member));
    };
  }
  f.value = p.number ? number_info(range) : vector_info(range);
  f.meaning = sentence(p.help);
  return f;
}

template <class T>
Field<T> box_field() {
  return Field<T>{"box",
                  [](Reading& in, const YamlNode& n, const std::string& path, T& out) {
                    const int before = in.problems.errors();
                    Box3d box;
                    read_map(in, n, path, box_schema(), box);
                    if (in.problems.errors() > before) return;
                    check_min_max(in, n, path, box);
                    out.box = box;
                  },
                  [](const T& t, const std::string& k, YamlNode& map) {
                    if (t.box) map.put(k, write_map(*t.box, box_schema()));
                  }}
      .takes(map_of(box_schema()))
      .says("Where it acts; absent: everywhere.");
}

/// A type's own keys, and those of the other types, which it does not have.
template <class F>
const Schema<FieldDraft<F>>& field_schema() {
  static const Schema<FieldDraft<F>> schema = [] {
    Schema<FieldDraft<F>> s;
    for (const MemberParam<F>& p : F::params) s.push_back(param<F>(p));
    s.push_back(box_field<FieldDraft<F>>());
    Fields::for_each([&]<class Other>() {
      for (const auto& p : Other::params) {
        if (std::any_of(s.begin(), s.end(), [&](const auto& f) { return f.key == p.key; })) continue;
        Field<FieldDraft<F>> foreign;
        foreign.key = std::string(p.key);
        s.push_back(std::move(foreign).refused(fmt::format("type {}", Other::name)));
      }
    });
    return s;
  }();
  return schema;
}

}  // namespace

void read_fields(Reading& in, const YamlNode& node, model::Scene& out) {
  std::vector<std::string> types;
  Fields::for_each([&]<class F>() { types.emplace_back(F::name); });
  read_named(in, node, "fields", [&](const Entry& e, const std::string& path) {
    ForceField& field = add_named(out.fields, e);
    if (!expect_map(in.problems, e.value, path)) return;
    const YamlNode* type = e.value.find("type");
    if (!type) return in.problems.error(e.value.at, fmt::format("missing key '{}.type'", path));
    const auto name = read_word(in.problems, *type, path + ".type", types);
    if (!name) return;
    Fields::for_each([&]<class F>() {
      if (F::name != *name) return;
      FieldDraft<F> draft;
      read_map(in, e.value, path, field_schema<F>(), draft, {"type"});
      field = as_model(draft.field);
      field.name = e.key, field.box = draft.box;
    });
  });
}

ValueInfo fields_info() {
  return names_info(map_of([] {
    MapInfo info;
    Fields::for_each([&]<class F>() {
      info.types.push_back({std::string(F::name), sentence(F::help), keys_info(field_schema<F>())});
    });
    return info;
  }));
}

YamlNode write_fields(const model::Scene& scene) {
  YamlNode all = YamlNode::map();
  for (const ForceField& f : scene.fields) {
    YamlNode one = YamlNode::map();
    one.put("type", YamlNode::scalar(f.type));
    Fields::for_each([&]<class F>() {
      if (F::name != f.type) return;
      const FieldDraft<F> draft{with_members<F>(f.numbers, f.vectors), f.box};
      for (Entry& e : write_map(draft, field_schema<F>()).entries) one.entries.push_back(std::move(e));
    });
    // The type has no such keys: to be refused.
    for (const auto& [key, value] : f.numbers)
      if (!one.find(key)) one.put(key, write_number(value));
    for (const auto& [key, value] : f.vectors)
      if (!one.find(key)) one.put(key, write_vector(value));
    all.put(f.name, std::move(one));
  }
  return all;
}

}  // namespace dreampm::scene
