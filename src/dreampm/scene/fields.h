// A section of a scene declared once: each key with how to read it, how to write it, when it
// applies, what it takes and what it means. Parser, messages, emitter and reference page all follow
// the same table.
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "dreampm/model/scene.h"
#include "dreampm/scene/value.h"
#include "dreampm/scene/value_info.h"

namespace dreampm::scene {

/// The state that readers share.
struct Reading {
  Problems& problems;
  std::string folder;               ///< of the scene file: mesh paths are looked for here first
  std::vector<std::string> assets;  ///< names that asset:NAME may have
  /// The place of models: beside the scene or in the working folder; in the scene's folder, as in a
  /// run's; or as named, which nobody looks at.
  enum class Models { looked_for, in_folder, as_named } models = Models::looked_for;
  std::map<std::string, model::Mark> marks{};  ///< where parts are said, by path
};

template <class T>
struct Field {
  std::string key;
  std::function<void(Reading&, const YamlNode&, const std::string& path, T&)> read;
  std::function<void(const T&, const std::string& key, YamlNode& map)> write;
  bool required = false;
  std::function<bool(const T&)> applies = {};   ///< empty: always; asked after the fields before it were read
  std::string only = {};                        ///< when it applies, in words
  std::function<bool(const T&)> optional = {};  ///< one that must be there need not where this holds
  ValueInfo value = {};
  std::string meaning = {};    ///< one sentence
  std::string otherwise = {};  ///< when it is optional, in words
  /// Writes it in any case, for the page; empty: `write` does.
  std::function<void(const T&, const std::string& key, YamlNode& map)> write_always = {};
  bool has_default = true;  ///< true if what is written of a fresh T is what holds without the key
  bool foreign = false;     ///< known only to be refused with a better message

  Field must() && {
    required = true;
    return std::move(*this);
  }
  Field unless(std::function<bool(const T&)> test, std::string words) && {
    required = true;
    optional = std::move(test);
    otherwise = std::move(words);
    return std::move(*this);
  }
  /// Sets the meaning, in one sentence.
  Field says(std::string words) && {
    meaning = std::move(words);
    return std::move(*this);
  }
  Field takes(ValueInfo info) && {
    value = std::move(info);
    return std::move(*this);
  }
  Field no_default() && {
    has_default = false;
    return std::move(*this);
  }
  /// It never applies here.
  Field refused(std::string words) && {
    foreign = true;
    return std::move(*this).when([](const T&) { return false; }, std::move(words));
  }
  Field when(std::function<bool(const T&)> test, std::string words) && {
    applies = std::move(test);
    only = std::move(words);
    return std::move(*this);
  }
};

/// Makes the field one that is only written when the test holds, and read in any case.
template <class T>
Field<T> written_when(Field<T> f, std::function<bool(const T&)> test) {
  f.write_always = f.write;
  f.write = [write = f.write, test = std::move(test)](const T& t, const std::string& k, YamlNode& map) {
    if (test(t)) write(t, k, map);
  };
  return f;
}

/// The fields of a map, in the order in which they are read and written.
template <class T>
using Schema = std::vector<Field<T>>;

template <class T>
KeyInfo key_info(const Field<T>& f, const T& fresh) {
  KeyInfo info{f.key, f.value, f.meaning, {}, f.required, f.otherwise, f.only};
  const auto& write = f.write_always ? f.write_always : f.write;
  if (!f.required && f.has_default && write) {
    YamlNode map = YamlNode::map();
    write(fresh, f.key, map);
    if (const YamlNode* value = map.find(f.key); value && !value->is_map()) info.by_default = *value;
  }
  return info;
}

template <class T>
std::vector<KeyInfo> keys_info(const Schema<T>& schema, const T& fresh = {}) {
  std::vector<KeyInfo> keys;
  for (const Field<T>& f : schema)
    if (!f.foreign) keys.push_back(key_info(f, fresh));
  return keys;
}

/// A map that the table describes.
template <class T>
ValueInfo map_of(Schema<T> schema, std::string name = {}) {
  return map_of([schema = std::move(schema)] { return MapInfo{keys_info(schema)}; }, std::move(name));
}

/// Reports two keys of which only one may be given. Both must be known keys of the map.
void check_alternatives(Problems& problems, const YamlNode& map, std::string_view path,
                        const std::vector<std::string>& known);

/// Returns the message for a key that no table knows, called `name` in full. A decimal comma in a
/// flow map makes one: {a: 0,5}.
std::string unknown_key(const YamlNode& map, const Entry& key, const std::string& name,
                        const std::vector<std::string>& known);

/// Reads a map by its table. Reports unknown keys, those that are missing or do not apply, and
/// either-or conflicts. `path` is empty for the whole scene. `others`: keys that the caller reads
/// itself.
template <class T>
void read_map(Reading& in, const YamlNode& node, const std::string& path, const Schema<T>& schema, T& out,
              const std::vector<std::string>& others = {}) {
  const auto within = [&](std::string_view key) {
    return path.empty() ? std::string(key) : fmt::format("{}.{}", path, key);
  };
  if (!expect_map(in.problems, node, path.empty() ? "the scene" : path)) return;
  std::vector<std::string> known = others, offered;
  for (const Field<T>& f : schema) known.push_back(f.key);
  for (const Field<T>& f : schema) {
    const YamlNode* value = node.find(f.key);
    const bool applies = !f.applies || f.applies(out);
    if (applies) offered.push_back(f.key);
    if (!value) {
      if (f.required && applies && !(f.optional && f.optional(out)))
        in.problems.error(node.at, fmt::format("missing key '{}'", within(f.key)));
      continue;
    }
    const auto entry =
        std::find_if(node.entries.begin(), node.entries.end(), [&](const Entry& e) { return e.key == f.key; });
    if (!applies)
      in.problems.error(entry->at, fmt::format("{} is only for {}", within(f.key), f.only));
    else
      f.read(in, *value, within(f.key), out);
  }
  for (const std::string& o : others) offered.push_back(o);
  for (const Entry& e : node.entries) {
    if (in.problems.full()) break;
    if (std::find(known.begin(), known.end(), e.key) == known.end())
      in.problems.error(e.at, unknown_key(node, e, within(e.key), offered));
  }
  check_alternatives(in.problems, node, path, known);
}

template <class T>
YamlNode write_map(const T& from, const Schema<T>& schema) {
  YamlNode map = YamlNode::map();
  for (const Field<T>& f : schema)
    if (f.write && (!f.applies || f.applies(from))) f.write(from, f.key, map);
  return map;
}

// Makers of fields. T is the struct; a member may be one of a base of it.

/// `read` gives an optional value, `write` a node. An optional member is written only if it has a
/// value.
template <class T, class M, class Read, class Write>
Field<T> plain(std::string key, M T::* member, Read read, Write write, ValueInfo info) {
  Field<T> f;
  f.key = std::move(key);
  f.read = [=](Reading& in, const YamlNode& n, const std::string& path, T& out) {
    if (auto v = read(in.problems, n, path)) out.*member = static_cast<M>(*v);
  };
  f.write = [=](const T& t, const std::string& k, YamlNode& map) {
    if constexpr (requires { (t.*member).has_value(); }) {
      if (t.*member) map.put(k, write(*(t.*member)));
    } else {
      map.put(k, write(t.*member));
    }
  };
  f.value = std::move(info);
  return f;
}

/// A reader of values in a range.
template <class Read>
auto within(const Range& range, Read read) {
  return [=](Problems& p, const YamlNode& n, const std::string& path) { return read(p, n, path, range); };
}

template <class T, class M>
Field<T> number(std::string key, M T::* member, Range range) {
  const auto read = within(range, [](auto&... all) { return read_number(all...); });
  return plain(std::move(key), member, read, write_number, number_info(range));
}

template <class T, class I>
Field<T> count(std::string key, I T::* member, std::int64_t min, std::int64_t max) {
  const auto read = [=](Problems& p, const YamlNode& n, const std::string& path) {
    return read_count(p, n, path, min, max);
  };
  const auto write = [](I i) { return write_count(static_cast<std::int64_t>(i)); };
  return plain(std::move(key), member, read, write, {WholeInfo{min, max}});
}

template <class T>
Field<T> flag(std::string key, bool T::* member) {
  return plain(std::move(key), member, read_flag, write_flag, {FlagInfo{}});
}

/// Written only if not empty.
template <class T>
Field<T> text(std::string key, std::string T::* member) {
  Field<T> f = plain(std::move(key), member, read_text, write_text, text_info("a text"));
  f.write = [member, write = f.write](const T& t, const std::string& k, YamlNode& map) {
    if (!(t.*member).empty()) write(t, k, map);
  };
  return f;
}

/// A list of texts, at least one and none twice: `what` says of which things each is the name.
/// Written only if not empty.
template <class T>
Field<T> names_of_things(std::string key, std::vector<std::string> T::* member, std::string what) {
  return Field<T>{std::move(key),
                  [=](Reading& in, const YamlNode& n, const std::string& path, T& out) {
                    if (!expect_list(in.problems, n, path)) return;
                    if (n.items.empty()) in.problems.error(n.at, fmt::format("{} is empty: give a {}", path, what));
                    std::vector<std::string>& list = out.*member;
                    for (std::size_t i = 0; i < n.items.size(); ++i) {
                      const auto name = read_text(in.problems, n.items[i], fmt::format("{}[{}]", path, i));
                      if (!name) continue;
                      if (std::find(list.begin(), list.end(), *name) != list.end())
                        in.problems.error(n.items[i].at, fmt::format("{} has '{}' twice", path, *name));
                      else
                        list.push_back(*name);
                    }
                  },
                  [=](const T& t, const std::string& k, YamlNode& map) {
                    std::vector<YamlNode> items;
                    for (const std::string& name : t.*member) items.push_back(write_text(name));
                    if (!items.empty()) map.put(k, YamlNode::list(std::move(items)));
                  }}
      .takes(list_info(text_info("the name of a " + what), 1));
}

template <class T, class M>
Field<T> vector(std::string key, M T::* member, Range range = {}) {
  const auto read = within(range, [](auto&... all) { return read_vector(all...); });
  return plain(std::move(key), member, read, write_vector, vector_info(range));
}

/// Of red, green and blue.
template <class T, class M>
Field<T> color(std::string key, M T::* member, Range range = between(0, 1)) {
  const auto read = within(range, [](auto&... all) { return read_vector(all..., "[red, green, blue]"); });
  return plain(std::move(key), member, read, write_vector, vector_info(range));
}

/// A word of an enum: the i-th word is the enumerator with value i.
template <class T, class E>
Field<T> choice(std::string key, E T::* member, std::vector<std::string> words) {
  return Field<T>{std::move(key),
                  [=](Reading& in, const YamlNode& n, const std::string& path, T& out) {
                    if (auto w = read_word(in.problems, n, path, words))
                      out.*member = static_cast<E>(std::find(words.begin(), words.end(), *w) - words.begin());
                  },
                  [=](const T& t, const std::string& k, YamlNode& map) {
                    map.put(k, YamlNode::scalar(words[static_cast<std::size_t>(t.*member)]));
                  }}
      .takes(word_info(words));
}

/// A map with a table of its own.
template <class T, class M>
Field<T> section(std::string key, M T::* member, Schema<M> schema) {
  return Field<T>{std::move(key),
                  [=](Reading& in, const YamlNode& n, const std::string& path, T& out) {
                    read_map(in, n, path, schema, out.*member);
                  },
                  [=](const T& t, const std::string& k, YamlNode& map) { map.put(k, write_map(t.*member, schema)); }}
      .takes(map_of(schema));
}

/// A map whose keys belong to the same struct.
template <class T>
Field<T> nested(std::string key, Schema<T> schema) {
  return Field<T>{
      std::move(key),
      [=](Reading& in, const YamlNode& n, const std::string& path, T& out) { read_map(in, n, path, schema, out); },
      [=](const T& t, const std::string& k, YamlNode& map) { map.put(k, write_map(t, schema)); }}
      .takes(map_of(schema));
}

/// A key of which there is one word so far.
template <class T>
Field<T> only_word(std::string key, std::string word) {
  return Field<T>{std::move(key),
                  [=](Reading& in, const YamlNode& n, const std::string& path, T&) {
                    read_word(in.problems, n, path, std::vector<std::string>{word});
                  },
                  [=](const T&, const std::string& k, YamlNode& map) { map.put(k, YamlNode::scalar(word)); }}
      .takes(word_info({word}));
}

}  // namespace dreampm::scene
