// How messages name a place in a scene file.
#pragma once
#include <fmt/format.h>

#include <string>

#include "dreampm/model/scene.h"

namespace dreampm {

/// The path of a part in a scene file: bodies.drop.
inline std::string path_of(const model::Material& m) { return "materials." + m.name; }
inline std::string path_of(const model::Body& b) { return "bodies." + b.name; }
inline std::string path_of(const model::Collider& c) {
  return (c.rigid ? "rigid." : c.pin ? "pins." : "colliders.") + c.name;
}
inline std::string path_of(const model::Emitter& e) { return "emitters." + e.name; }
inline std::string path_of(const model::Sink& s) { return "sinks." + s.name; }
inline std::string path_of(const model::Probe& p) { return "probes." + p.name; }

/// file:line:column of what the file says at a path; the file alone where it says nothing there,
/// for a scene that was made in memory.
inline std::string place(const std::string& file, const model::Scene& scene, const std::string& path) {
  const auto mark = scene.marks.find(path);
  return mark != scene.marks.end() && mark->second.line > 0
             ? fmt::format("{}:{}:{}", file, mark->second.line, mark->second.column)
             : file;
}
template <class Part>
  requires requires(const Part& part) { path_of(part); }
std::string place(const std::string& file, const model::Scene& scene, const Part& part) {
  return place(file, scene, path_of(part));
}

}  // namespace dreampm
