// motion: of colliders, emitters and sinks, by keys or constant.
#include "dreampm/scene/sections.h"

namespace dreampm::scene {
namespace {

/// A key as a scene gives it: what it leaves out is as in the key before.
struct KeyDraft {
  double t = 0;
  std::optional<Vec3d> position;
  std::optional<Turn> turn;
};

Field<KeyDraft> rotate() {
  static const Schema<Turn> schema = turn_schema(1e6);
  return Field<KeyDraft>{"rotate",
                         [](Reading& in, const YamlNode& n, const std::string& path, KeyDraft& out) {
                           read_map(in, n, path, schema, out.turn.emplace());
                         },
                         [](const KeyDraft& k, const std::string& name, YamlNode& map) {
                           if (k.turn) map.put(name, write_map(*k.turn, schema));
                         }}
      .takes(map_of(schema, "motion.rotate"))
      .says("The turn from how the shape stands in the scene; without it as at the key before.");
}

const Schema<KeyDraft>& key_schema() {
  static const Schema<KeyDraft> schema{
      number("t", &KeyDraft::t, at_least_zero("s")).must().says("The time of the key."),
      vector("position", &KeyDraft::position, any_number("m"))
          .says("How far the shape is moved from where it stands in the scene; without it as at the key before."),
      rotate()};
  return schema;
}

Field<Motion> keys() {
  return Field<Motion>{
      "keys",
      [](Reading& in, const YamlNode& n, const std::string& path, Motion& out) {
        if (!expect_list(in.problems, n, path)) return;
        if (n.items.empty()) in.problems.error(n.at, fmt::format("{} is empty: give at least one key", path));
        for (std::size_t i = 0; i < n.items.size(); ++i) {
          const std::string name = fmt::format("{}[{}]", path, i);
          const int before = in.problems.errors();
          KeyDraft draft;
          read_map(in, n.items[i], name, key_schema(), draft);
          if (in.problems.errors() > before) continue;
          PoseKey key = out.keys.empty() ? PoseKey{} : out.keys.back();
          if (!out.keys.empty() && !(draft.t > key.t))
            in.problems.error(
                n.items[i].find("t")->at,
                fmt::format("{}.t is {}: keys must follow in time, the one before is at {} s", name, draft.t, key.t));
          key.t = draft.t;
          key.position = draft.position.value_or(key.position);
          if (draft.turn) key.rotate_axis = draft.turn->axis, key.rotate_angle = draft.turn->angle;
          out.keys.push_back(key);
        }
      },
      [](const Motion& m, const std::string& name, YamlNode& map) {
        if (m.keys.empty()) return;
        std::vector<YamlNode> items;
        for (const PoseKey& k : m.keys)
          items.push_back(write_map(KeyDraft{k.t, k.position, Turn{k.rotate_axis, k.rotate_angle}}, key_schema()));
        map.put(name, YamlNode::list(std::move(items)));
      }}
      .takes(list_info(map_of(key_schema()), 1))
      .says("Poses by time, in rising order.");
}

Field<Motion> ease() {
  static const std::vector<std::string> words{"linear", "smooth"};
  return Field<Motion>{"ease",
                       [](Reading& in, const YamlNode& n, const std::string& path, Motion& out) {
                         if (const auto w = read_word(in.problems, n, path, words)) out.smooth = *w == "smooth";
                       },
                       [](const Motion& m, const std::string& name, YamlNode& map) {
                         if (m.smooth) map.put(name, YamlNode::scalar("smooth"));
                       }}
      .takes(word_info(words))
      .says("How it moves between keys: at constant speed (`linear`, if absent) or slowing down at each (`smooth`).");
}

}  // namespace

const Schema<Motion>& motion_schema() {
  const auto keyed = [](const Motion& m) { return !m.keys.empty(); };
  const auto constant = [](const Motion& m) { return m.keys.empty(); };
  static const Schema<Motion> schema{
      keys(),
      ease().when(keyed, "motions with keys"),
      written_when<Motion>(vector("velocity", &Motion::velocity, any_number("m/s")),
                           [](const Motion& m) { return !(m.velocity == Vec3d{}); })
          .when(constant, "motions without keys")
          .says("A constant velocity."),
      written_when<Motion>(vector("spin", &Motion::spin, any_number("rad/s")),
                           [](const Motion& m) { return !(m.spin == Vec3d{}); })
          .when(constant, "motions without keys")
          .says("A constant spin: axis times angular speed."),
      vector("about", &Motion::about, any_number("m"))
          .says("The point that it turns about, where it stands in the scene; its middle if absent."),
  };
  return schema;
}

}  // namespace dreampm::scene
