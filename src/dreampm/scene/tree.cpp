#include "dreampm/scene/tree.h"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <sstream>

namespace dreampm::scene {
namespace {

constexpr std::size_t max_bytes = 4u << 20, max_nodes = 100000;
constexpr int max_depth = 40;

/// Looks over a text before a tree is made of it, which takes memory for every value: whether it is
/// too large, and where a second document begins. yaml-cpp's own loop over documents does not end
/// where it comes to what begins none, such as a comma.
class Documents final : public YAML::EventHandler {
 public:
  struct TooManyValues {
    YAML::Mark at;
  };
  /// Throws what yaml-cpp throws, or TooManyValues.
  explicit Documents(const std::string& text) {
    std::istringstream in(text);
    YAML::Parser parser(in);
    if (parser.HandleNextDocument(*this)) parser.HandleNextDocument(*this);
  }
  bool has_second() const { return starts_.size() > 1; }
  /// Returns the place of its first value.
  const YAML::Mark& second() const { return second_; }
  /// True if no text was taken: the second begins where the first did.
  bool none_begins() const { return has_second() && starts_[0].pos == starts_[1].pos; }

  void OnDocumentStart(const YAML::Mark& at) override { starts_.push_back(at); }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& at, YAML::anchor_t) override { add(at); }
  void OnAlias(const YAML::Mark& at, YAML::anchor_t) override { add(at); }
  void OnScalar(const YAML::Mark& at, const std::string&, YAML::anchor_t, const std::string&) override { add(at); }
  void OnSequenceStart(const YAML::Mark& at, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {
    add(at);
  }
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark& at, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {
    add(at);
  }
  void OnMapEnd() override {}

 private:
  void add(const YAML::Mark& at) {
    if (++values_ > 2 * max_nodes) throw TooManyValues{at};  // keys are values here
    if (has_second() && second_.is_null()) second_ = at;
  }
  std::vector<YAML::Mark> starts_;
  YAML::Mark second_ = YAML::Mark::null_mark();
  std::size_t values_ = 0;
};

class Reader {
 public:
  Reader(const std::string& file, Problems& problems) : file_(file), problems_(problems) {}

  Place place(const YAML::Mark& m) const {
    if (m.is_null() || m.line < 0) return {file_, 0, 0};
    return {file_, m.line + 1, m.column + 1};  // yaml-cpp counts from 0
  }

  YamlNode convert(const YAML::Node& from, int depth) {
    YamlNode n;
    n.at = place(from.Mark());
    if (too_much_) return n;
    if (++nodes_ > max_nodes || depth > max_depth) {
      problems_.error(n.at, depth > max_depth ? "nested too deeply (or an alias inside its own anchor)"
                                              : fmt::format("more than {} values", max_nodes));
      too_much_ = true;
      return n;
    }
    const std::string& tag = from.Tag();
    if (!tag.empty() && tag != "?" && tag != "!")
      problems_.error(n.at, fmt::format("tags are not supported: remove '{}'", tag));
    switch (from.Type()) {
      case YAML::NodeType::Scalar:
        n.kind = YamlNode::Kind::scalar;
        n.text = from.Scalar();
        n.quoted = tag == "!";
        break;
      case YAML::NodeType::Sequence:
        n.kind = YamlNode::Kind::list;
        for (const YAML::Node& item : from) n.items.push_back(convert(item, depth + 1));
        break;
      case YAML::NodeType::Map:
        n.kind = YamlNode::Kind::map;
        {
          std::map<std::string, Place> known;
          for (const auto& pair : from) add(n, known, pair.first, pair.second, depth);
        }
        break;
      default:
        break;
    }
    return n;
  }

 private:
  /// `known` are the keys of that map, and where each stands.
  void add(YamlNode& map, std::map<std::string, Place>& known, const YAML::Node& key, const YAML::Node& value,
           int depth) {
    const Place at = place(key.Mark());
    if (!key.IsScalar()) return problems_.error(at, "a key must be a word");
    const std::string& word = key.Scalar();
    if (word == "<<") return problems_.error(at, "merge keys (<<) are not supported: write the values out");
    if (const auto [e, is_new] = known.try_emplace(word, at); !is_new) {
      const std::string first = e->second.line > 0 ? fmt::format(" (first in line {})", e->second.line) : "";
      return problems_.error(at, fmt::format("duplicate key '{}'{}", word, first));
    }
    YamlNode child = convert(value, depth + 1);
    if (child.at.line == 0) child.at = at;
    map.entries.push_back({word, at, std::move(child)});
  }

  const std::string& file_;
  Problems& problems_;
  std::size_t nodes_ = 0;
  bool too_much_ = false;
};

/// yaml-cpp takes tabs in many places where YAML forbids them, and quotes nothing back: no tab
/// anywhere is simplest.
void find_tabs(std::string_view text, const std::string& file, Problems& problems) {
  int line = 1, column = 0;
  for (const char c : text) {
    if (c == '\n') {
      ++line, column = 0;
      continue;
    }
    if ((static_cast<unsigned char>(c) & 0xc0) != 0x80) ++column;  // one column a character, not a byte
    if (c == '\t') return problems.error({file, line, column}, "a tab: indent and separate with spaces");
  }
}

void place_all(YamlNode& n, const Place& at) {
  n.at = at;
  for (YamlNode& i : n.items) place_all(i, at);
  for (Entry& e : n.entries) e.at = at, place_all(e.value, at);
}

}  // namespace

YamlNode YamlNode::scalar(std::string text, bool quoted) {
  YamlNode n;
  n.kind = Kind::scalar;
  n.text = std::move(text);
  n.quoted = quoted;
  return n;
}
YamlNode YamlNode::list(std::vector<YamlNode> items) {
  YamlNode n;
  n.kind = Kind::list;
  n.items = std::move(items);
  return n;
}
YamlNode YamlNode::map() {
  YamlNode n;
  n.kind = Kind::map;
  return n;
}
const YamlNode* YamlNode::find(std::string_view key) const {
  for (const Entry& e : entries)
    if (e.key == key) return &e.value;
  return nullptr;
}
YamlNode* YamlNode::find(std::string_view key) { return const_cast<YamlNode*>(std::as_const(*this).find(key)); }
void YamlNode::put(std::string key, YamlNode value) { entries.push_back({std::move(key), {}, std::move(value)}); }

std::string YamlNode::describe() const {
  switch (kind) {
    case Kind::null:
      return "nothing";
    case Kind::list:
      return "a list";
    case Kind::map:
      return "a map";
    case Kind::scalar:
      break;
  }
  return text.size() > 60 ? fmt::format("'{}...'", text.substr(0, 60)) : fmt::format("'{}'", text);
}

YamlNode read_yaml(std::string_view text, const std::string& file, Problems& problems) {
  if (text.size() > max_bytes) {
    problems.error({file, 0, 0}, fmt::format("{} bytes: a scene has at most {}", text.size(), max_bytes));
    return {};
  }
  if (const auto zero = text.find('\0'); zero != text.npos) {
    problems.error({file, 0, 0}, fmt::format("byte {} is zero: this is not a text file", zero));
    return {};
  }
  Reader reader(file, problems);
  find_tabs(text, file, problems);
  try {
    const std::string whole(text);
    const Documents documents(whole);
    if (documents.none_begins()) {
      problems.error(reader.place(documents.second()), "not valid YAML: nothing may begin so");
      return {};
    }
    if (documents.has_second())
      problems.error(reader.place(documents.second()), "a second document: a scene file holds one");
    const YAML::Node first = YAML::Load(whole);
    if (first.IsNull()) {
      problems.error({file, 0, 0}, "the file is empty; a scene starts with 'dreampm: 1'");
      return {};
    }
    return reader.convert(first, 0);
  } catch (const Documents::TooManyValues& e) {
    problems.error(reader.place(e.at), fmt::format("more than {} values", max_nodes));
    return {};
  } catch (const YAML::Exception& e) {
    // A tab is often the cause: one message is enough.
    if (problems.errors() == 0) problems.error(reader.place(e.mark), fmt::format("not valid YAML: {}", e.msg));
    return {};
  }
}

YamlNode read_override(const std::string& argument, const std::string& source, Problems& problems) {
  const Place at{source + argument, 0, 0};
  const auto equals = argument.find('=');
  YamlNode root = YamlNode::map();
  if (equals == argument.npos || equals == 0 || equals + 1 == argument.size()) {
    problems.error(at, "must read PATH=VALUE, as in space.spacing=0.01");
    return root;
  }
  const std::string path = argument.substr(0, equals);
  Problems inner;
  YamlNode value = read_yaml(std::string_view(argument).substr(equals + 1), "", inner);
  for (const Problem& p : inner.list()) problems.error(at, p.message);
  YamlNode* map = &root;
  for (std::size_t from = 0; from <= path.size();) {
    const std::size_t dot = std::min(path.find('.', from), path.size());
    if (dot == from) {
      problems.error(at, "an empty name in the path");
      return YamlNode::map();
    }
    const bool last = dot == path.size();
    map->put(path.substr(from, dot - from), last ? std::move(value) : YamlNode::map());
    map = &map->entries.back().value;
    from = dot + 1;
  }
  place_all(root, at);
  return root;
}

}  // namespace dreampm::scene
