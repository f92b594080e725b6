#include "dreampm/io/run_record.h"

#include <array>
#include <nlohmann/json.hpp>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/version.h"

namespace dreampm {
namespace {
using Json = nlohmann::ordered_json;

template <class T>
Json or_null(const std::optional<T>& v) {
  return v ? Json(*v) : Json(nullptr);
}

template <class T>
void put(Json& to, const char* key, const std::optional<T>& v) {
  if (v) to[key] = *v;
}

// A value with the way to it, for messages.
class JsonNode {
 public:
  JsonNode(const Json& json, std::string source, std::string path)
      : json_(json), source_(std::move(source)), path_(std::move(path)) {}

  bool has(const char* key) const {
    expect(json_.is_object(), "an object");
    return json_.contains(key) && !json_[key].is_null();
  }
  JsonNode at(const std::string& key) const {
    expect(json_.is_object(), "an object");
    if (!json_.contains(key)) fail_input("{}: {} is missing", source_, way(key));
    return JsonNode(json_[key], source_, way(key));
  }
  template <class T>
  T get(const std::string& key) const {
    return at(key).as<T>();
  }
  template <class T>
  std::optional<T> maybe(const char* key) const {
    if (!has(key)) return std::nullopt;
    return get<T>(key);
  }
  template <class T>
  T as() const {
    if constexpr (std::is_same_v<T, std::string>) {
      expect(json_.is_string(), "a text");
    } else if constexpr (std::is_floating_point_v<T>) {
      expect(json_.is_number(), "a number");
    } else {
      expect(json_.is_number_unsigned() && json_.get<std::uint64_t>() <= std::uint64_t(std::numeric_limits<T>::max()),
             "a whole number, not negative");
    }
    return json_.get<T>();
  }
  template <class Each>
  void each(const Each& take) const {
    expect(json_.is_array(), "a list");
    for (std::size_t i = 0; i < json_.size(); ++i) take(JsonNode(json_[i], source_, fmt::format("{}[{}]", path_, i)));
  }
  template <class Each>
  void each_key(const Each& take) const {
    expect(json_.is_object(), "an object");
    for (const auto& item : json_.items()) take(item.key(), JsonNode(item.value(), source_, way(item.key())));
  }

 private:
  std::string way(const std::string& key) const { return path_.empty() ? key : path_ + "." + key; }
  void expect(bool ok, const char* wanted) const {
    if (ok) return;
    // Lists within lists are not written: how deep they go, the file says.
    std::string is = json_.is_array()    ? "a list"
                     : json_.is_object() ? "an object"
                                         : json_.dump(-1, ' ', false, Json::error_handler_t::replace);
    if (is.size() > 60) is.resize(60), is += "..";
    fail_input("{}: {} must be {}, is {}", source_, path_.empty() ? "the file" : path_, wanted, is);
  }
  const Json& json_;
  std::string source_, path_;
};

constexpr const char* stage_names[] = {"simulate", "foam", "surface", "render", "video"};  // in the order they run

/// The counts of a record, by their keys.
template <class Record, class Each>
void each_count(Record& f, const Each& each) {
  each("crest", f.crest), each("trapped_air", f.trapped_air), each("vorticity", f.vorticity);
  each("beside_walls", f.beside_walls), each("aged", f.aged), each("at_walls", f.at_walls);
  each("outside", f.outside), each("thinned", f.thinned);
  each("spray", f.spray), each("foam", f.foam), each("bubbles", f.bubbles), each("dust", f.dust);
}

Json foam_json(const FoamRecord& f) {
  Json j = {{"frame", f.frame}};
  each_count(f, [&](const char* key, std::uint64_t n) { j[key] = n; });
  j["place"] = {f.place.x, f.place.y, f.place.z};
  return j;
}

Json stage_json(const StageRecord& s) {
  Json j = Json::object();
  put(j, "seconds", s.seconds);
  put(j, "frames", s.frames);
  put(j, "particle_steps", s.particle_steps);
  put(j, "peak_memory_bytes", s.peak_memory_bytes);
  put(j, "settings_hash", s.settings_hash);
  put(j, "status", s.status);
  put(j, "cause", s.cause);
  for (const VolumeRecord& v : s.volumes) {
    Json volume = {{"frame", v.frame}, {"material", v.material}, {"particles", v.particles}, {"mesh", v.mesh}};
    put(volume, "taken", v.taken);
    j["volumes"].push_back(std::move(volume));
  }
  for (const FoamRecord& f : s.foam) j["foam"].push_back(foam_json(f));
  for (const PictureRecord& p : s.pictures)
    j["pictures"].push_back({{"frame", p.frame}, {"samples", p.samples}, {"error", p.error}, {"at_limit", p.at_limit}});
  if (!s.found.empty()) j["found"] = s.found;
  return j;
}

FoamRecord foam_record(const JsonNode& n) {
  FoamRecord f;
  f.frame = n.get<int>("frame");
  each_count(f, [&](const char* key, std::uint64_t& count) { count = n.get<std::uint64_t>(key); });
  int axis = 0;
  n.at("place").each([&](const JsonNode& x) {
    const double value = x.as<double>();
    if (axis < 3) f.place[axis++] = value;
  });
  return f;
}

StageRecord stage_record(const JsonNode& n) {
  StageRecord s;
  s.seconds = n.maybe<double>("seconds");
  s.frames = n.maybe<std::uint64_t>("frames");
  s.particle_steps = n.maybe<std::uint64_t>("particle_steps");
  s.peak_memory_bytes = n.maybe<std::uint64_t>("peak_memory_bytes");
  s.settings_hash = n.maybe<std::string>("settings_hash");
  s.status = n.maybe<std::string>("status");
  s.cause = n.maybe<std::string>("cause");
  if (n.has("volumes"))
    n.at("volumes").each([&](const JsonNode& v) {
      s.volumes.push_back({v.get<int>("frame"), v.get<std::string>("material"), v.get<double>("particles"),
                           v.get<double>("mesh"), v.maybe<double>("taken")});
    });
  if (n.has("foam")) n.at("foam").each([&](const JsonNode& f) { s.foam.push_back(foam_record(f)); });
  if (n.has("pictures"))
    n.at("pictures").each([&](const JsonNode& p) {
      s.pictures.push_back(
          {p.get<int>("frame"), p.get<double>("samples"), p.get<double>("error"), p.get<double>("at_limit")});
    });
  if (n.has("found"))
    n.at("found").each_key([&](const std::string& key, const JsonNode& v) { s.found[key] = v.as<double>(); });
  return s;
}

constexpr std::array<const char*, 7> pose_keys{"x", "y", "z", "qw", "qx", "qy", "qz"};

FrameRecord frame_record(const JsonNode& n) {
  FrameRecord f;
  f.frame = n.get<int>("frame");
  f.time = n.get<double>("time");
  f.substeps = n.get<std::uint64_t>("substeps");
  f.state_hash = n.get<std::string>("state_hash");
  f.particles = n.get<std::uint64_t>("particles");
  f.left = n.get<std::uint64_t>("left");
  if (n.has("poses"))
    n.at("poses").each([&](const JsonNode& p) {
      std::array<double, 7> at{};
      for (std::size_t i = 0; i < at.size(); ++i) at[i] = p.get<double>(pose_keys[i]);
      f.poses[p.get<std::string>("name")] = {{at[0], at[1], at[2]}, {at[3], at[4], at[5], at[6]}};
    });
  return f;
}

}  // namespace

RunRecord RunRecord::for_this_build() {
  RunRecord r;
  r.dreampm = version;
  r.commit = dreampm::commit;
  for (const char* stage : stage_names) r.stages[stage] = {};
  return r;
}

void RunRecord::end_stage(const std::string& stage, std::optional<std::string> how, std::optional<std::string> why) {
  stages[stage].status = std::move(how);
  stages[stage].cause = std::move(why);
  for (const char* name : stage_names)
    if (const StageRecord& s = stages[name]; s.status == "failed") {
      status = "failed";
      cause = s.cause;
      failed_stage = name;
      return;
    }
  // A record of an earlier version says how the simulation ended in `status` alone.
  if (const auto& simulated = stages["simulate"].status) status = *simulated;
  if (status != "failed") cause.reset();
  failed_stage.reset();
}

std::string RunRecord::to_json() const {
  Json j;
  j["format"] = format;
  j["dreampm"] = dreampm;
  j["commit"] = commit;
  j["scene"] = scene;
  j["variant"] = or_null(variant);
  j["scene_hash"] = scene_hash;
  j["status"] = status;
  j["cause"] = or_null(cause);
  put(j, "stage", failed_stage);
  j["machine"] = {{"cpu", machine.cpu},
                  {"cores", machine.cores},
                  {"threads", machine.threads},
                  {"isa", machine.isa},
                  {"memory_bytes", machine.memory_bytes}};
  j["particles"] = particles;
  j["spacing"] = spacing;
  j["dx"] = dx;
  j["shift"] = {shift.x, shift.y, shift.z};
  j["backend"] = backend;
  for (const EarlierBackend& b : earlier_backends)
    j["earlier_backends"].push_back({{"backend", b.backend}, {"isa", b.isa}, {"last_frame", b.last_frame}});
  j["bodies"] = Json::array();
  for (const BodyRecord& b : bodies)
    j["bodies"].push_back({{"name", b.name}, {"first_id", b.first_id}, {"count", b.count}});
  j["frames"] = Json::array();
  for (const FrameRecord& f : frames) {
    Json& frame = j["frames"].emplace_back(Json{{"frame", f.frame},
                                                {"time", f.time},
                                                {"substeps", f.substeps},
                                                {"state_hash", f.state_hash},
                                                {"particles", f.particles},
                                                {"left", f.left}});
    for (const auto& [body, pose] : f.poses) {
      Json& one = frame["poses"].emplace_back(Json{{"name", body}});
      const auto& [at, turn] = pose;
      const std::array<double, 7> n{at.x, at.y, at.z, turn.w, turn.x, turn.y, turn.z};
      for (std::size_t i = 0; i < n.size(); ++i) one[pose_keys[i]] = n[i];
    }
  }
  j["stages"] = Json::object();
  for (const char* name : stage_names)
    if (const auto s = stages.find(name); s != stages.end()) j["stages"][name] = stage_json(s->second);
  for (const auto& [name, s] : stages)
    if (!j["stages"].contains(name)) j["stages"][name] = stage_json(s);
  if (!probes.empty()) j["probes"] = probes;
  j["warnings"] = warnings;
  // A path may hold any bytes; JSON may not.
  return j.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

RunRecord RunRecord::from_json(const std::string& text, const std::string& source) {
  Json json;
  try {
    json = Json::parse(text);
  } catch (const Json::parse_error& e) {
    fail_input("{}: not JSON, or truncated, at byte {}", source, e.byte);
  } catch (const Json::exception& e) {  // a number beyond what a double holds
    fail_input("{}: not JSON that can be read: {}", source, e.what());
  }
  const JsonNode n(json, source, "");
  const int found = n.get<int>("format");
  if (found != format) fail_input("{}: format {}; this dreampm reads format {}", source, found, format);
  RunRecord r;
  r.dreampm = n.get<std::string>("dreampm");
  r.commit = n.get<std::string>("commit");
  r.scene = n.get<std::string>("scene");
  r.variant = n.maybe<std::string>("variant");
  r.scene_hash = n.get<std::string>("scene_hash");
  r.status = n.get<std::string>("status");
  if (r.status != "complete" && r.status != "interrupted" && r.status != "failed")
    fail_input("{}: status must be complete, interrupted or failed, is \"{}\"", source, r.status);
  r.cause = n.maybe<std::string>("cause");
  r.failed_stage = n.maybe<std::string>("stage");
  const JsonNode m = n.at("machine");
  r.machine = {m.get<std::string>("cpu"), m.get<int>("cores"), m.get<int>("threads"), m.get<std::string>("isa"),
               m.get<std::uint64_t>("memory_bytes")};
  r.particles = n.get<std::uint64_t>("particles");
  r.spacing = n.get<double>("spacing");
  r.dx = n.get<double>("dx");
  if (n.has("shift")) {
    int axis = 0;
    n.at("shift").each([&](const JsonNode& x) {
      const double value = x.as<double>();
      if (axis < 3) r.shift[axis] = value;
      ++axis;
    });
    if (axis != 3) fail_input("{}: shift has {} numbers, must have 3", source, axis);
  }
  r.backend = n.get<std::string>("backend");
  if (n.has("earlier_backends"))
    n.at("earlier_backends").each([&](const JsonNode& b) {
      r.earlier_backends.push_back(
          {b.get<std::string>("backend"), b.get<std::string>("isa"), b.get<int>("last_frame")});
    });
  if (n.has("bodies"))
    n.at("bodies").each([&](const JsonNode& b) {
      r.bodies.push_back({b.get<std::string>("name"), b.get<std::uint64_t>("first_id"), b.get<std::uint64_t>("count")});
    });
  n.at("frames").each([&](const JsonNode& f) { r.frames.push_back(frame_record(f)); });
  n.at("stages").each_key([&](const std::string& name, const JsonNode& s) { r.stages[name] = stage_record(s); });
  if (n.has("probes"))
    n.at("probes").each_key([&](const std::string& name, const JsonNode& p) { r.probes[name] = p.as<std::string>(); });
  n.at("warnings").each([&](const JsonNode& w) { r.warnings.push_back(w.as<std::string>()); });
  return r;
}

void RunRecord::save(const std::filesystem::path& file) const { replace_file_text(file, to_json()); }

RunRecord RunRecord::load(const std::filesystem::path& file) { return from_json(read_file(file), file.string()); }

}  // namespace dreampm
