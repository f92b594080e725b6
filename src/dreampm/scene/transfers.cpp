// transfer: how a material's particles and the grid exchange velocities. The keys come from each
// type's own table.
#include <fmt/ranges.h>

#include <map>

#include "dreampm/physics/transfers.h"
#include "dreampm/scene/sections.h"

namespace dreampm::scene {

namespace {
bool is_given(double number) { return number != KeptVelocity::absent; }
}  // namespace

const std::vector<std::string>& transfer_keys() {
  static const std::vector<std::string> keys = [] {
    std::vector<std::string> list{"transfer"};
    Transfers::for_each([&]<class T>() {
      for (const auto& p : T::params)
        if (std::find(list.begin(), list.end(), p.key) == list.end()) list.emplace_back(p.key);
    });
    return list;
  }();
  return keys;
}

void read_transfer(Reading& in, const YamlNode& material, const std::string& path, Material& out) {
  std::string chosen(Apic::name);
  if (const YamlNode* n = material.find("transfer")) {
    std::vector<std::string> names;
    Transfers::for_each([&]<class T>() { names.emplace_back(T::name); });
    const auto name = read_word(in.problems, *n, path + ".transfer", names);
    if (!name) return;
    chosen = *name;
  }
  for (const Entry& e : material.entries) {
    const auto& keys = transfer_keys();
    if (e.key == "transfer" || std::find(keys.begin(), keys.end(), e.key) == keys.end()) continue;
    const std::string name = fmt::format("{}.{}", path, e.key);
    std::vector<std::string> owners;
    bool own = false;
    Transfers::for_each([&]<class T>() {
      for (const auto& p : T::params)
        if (p.key == e.key) owners.emplace_back(T::name), own = own || T::name == chosen;
    });
    if (!own) in.problems.error(e.at, fmt::format("{} is only for transfer {}", name, fmt::join(owners, " and ")));
  }
  if (const YamlNode* n = material.find("flip_memory"); n && material.find("flip_blend"))
    in.problems.error(n->at,
                      fmt::format("{0}.flip_memory and {0}.flip_blend: what is kept is given by time or by step, "
                                  "so give one of them",
                                  path));
  Transfers::for_each([&]<class T>() {
    if (T::name != chosen) return;
    out.transfer = chosen;
    for (const MemberParam<T>& p : T::params) {
      std::optional<double> value;
      if (is_given(T{}.*p.number)) value = T{}.*p.number;
      if (const YamlNode* n = material.find(p.key))
        value = read_number(in.problems, *n, fmt::format("{}.{}", path, p.key), {p.min, p.max, p.above, false, p.unit});
      if (value) out.transfer_values.set(p.key, *value);
    }
  });
}

std::vector<KeyInfo> transfer_info() {
  std::vector<std::string> names;
  std::vector<KeyInfo> keys;
  std::map<std::string, std::vector<std::string>> owners, defaults;
  Transfers::for_each([&]<class T>() {
    names.emplace_back(T::name);
    for (const MemberParam<T>& p : T::params) {
      const std::string key(p.key);
      if (owners[key].empty())
        keys.push_back({key, number_info({p.min, p.max, p.above, false, p.unit}), sentence(p.help)});
      owners[key].emplace_back(T::name);
      if (is_given(T{}.*p.number)) defaults[key].push_back(fmt::format("{} of {}", T{}.*p.number, T::name));
    }
  });
  for (KeyInfo& k : keys) {
    k.meaning += defaults[k.key].empty()
                     ? " Without flip_blend and flip_memory, the memory follows from cell, sound and gravity."
                     : fmt::format(" Absent: {}.", fmt::join(defaults[k.key], ", "));
    k.only = fmt::format("transfer {}", fmt::join(owners[k.key], " and "));
  }
  keys.insert(keys.begin(), {"transfer", word_info(names), "How its particles and the grid exchange velocities.",
                             YamlNode::scalar(std::string(Apic::name))});
  return keys;
}

void write_transfer(const Material& from, YamlNode& material) {
  if (from.transfer != Apic::name) material.put("transfer", YamlNode::scalar(from.transfer));
  std::visit(
      [&]<class T>(const T& transfer) {
        for (const MemberParam<T>& p : T::params)
          if (is_given(transfer.*p.number)) material.put(std::string(p.key), write_number(transfer.*p.number));
      },
      make_transfer(from.transfer, from.transfer_values));
  for (const auto& [key, value] : from.transfer_values)  // the transfer has no such key: to be refused
    if (!material.find(key)) material.put(key, write_number(value));
}

}  // namespace dreampm::scene
