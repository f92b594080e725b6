#include "dreampm/pictures/surface_attributes.h"

#include <algorithm>

#include "dreampm/base/error.h"
#include "dreampm/pictures/draw.h"
#include "dreampm/surface/carry.h"

namespace dreampm {
namespace {

/// A mesh and the particles of its material.
struct Wrapped {
  const model::Scene& scene;
  int material;
  const ParticleFrame& frame;
  const TriMesh& mesh;
  const std::vector<BodyRecord>& bodies;
  const std::string& file;
  MaterialParticles particles = particles_of(scene, material, frame);

  surface::Carriers carriers() const { return {particles.position, static_cast<float>(scene.space.spacing)}; }
  /// A column of the frame, of the particles of the material.
  std::vector<float> column(const std::string& name) const {
    const auto found = frame.columns.find(name);
    if (found == frame.columns.end())
      fail_input("{}: has no column {}, of which surface.attributes makes {}: simulate again with this scene", file,
                 name, name);
    const std::string& own = scene.materials[static_cast<std::size_t>(material)].name;
    std::vector<float> values;
    for (std::size_t i = 0; i < frame.size(); ++i)
      if (frame.material_names.at(frame.material[i]) == own) values.push_back(found->second[i]);
    return values;
  }
};

std::vector<float> colors_of(const Wrapped& w) {
  if (!many_colored(w.scene, w.material))
    return flat(std::vector<Vec3f>(w.mesh.vertices.size(), matter_color(w.scene, w.material)));
  const std::vector<Vec3f> colors = particle_colors(w.scene, w.material, w.frame, w.bodies);
  const Mixing mixing = mixing_of(material_look(w.scene, w.material));
  return flat(surface::carry_colors(w.mesh.vertices, w.carriers(), colors, mixing));
}
std::vector<float> mean_of(const Wrapped& w, const char* name) {
  return surface::carry_numbers(w.mesh.vertices, w.carriers(), w.column(name));
}

struct Maker {
  const char* name;
  AttributeKind kind;
  std::vector<float> (*make)(const Wrapped&);
};
/// All but the velocity.
constexpr Maker makers[] = {
    {"color", AttributeKind::color, colors_of},
    {"source", AttributeKind::whole,
     [](const Wrapped& w) { return surface::carry_names(w.mesh.vertices, w.carriers(), w.column("source")); }},
    {"age", AttributeKind::number, [](const Wrapped& w) { return mean_of(w, "age"); }},
    {"j", AttributeKind::number, [](const Wrapped& w) { return mean_of(w, "j"); }},
    {"vorticity", AttributeKind::vector,
     [](const Wrapped& w) {
       return flat(surface::carry_vorticity(w.mesh.vertices, w.carriers(), w.particles.velocity));
     }},
};
static_assert(std::size(makers) + 1 == model::surface_attributes.size());

}  // namespace

bool has_surface_attribute(const model::Scene& scene, std::string_view name) {
  const auto& wanted = scene.surface.attributes;
  return std::find(wanted.begin(), wanted.end(), name) != wanted.end();
}

VertexAttributes surface_attributes(const model::Scene& scene, int material, const ParticleFrame& frame,
                                    const TriMesh& mesh, const std::vector<BodyRecord>& bodies,
                                    const std::string& file) {
  VertexAttributes out;
  std::vector<const Maker*> wanted;
  for (const Maker& m : makers)
    if (has_surface_attribute(scene, m.name)) wanted.push_back(&m);
  if (wanted.empty()) return out;
  const Wrapped wrapped{scene, material, frame, mesh, bodies, file};
  for (const Maker* m : wanted)
    out.push_back({m->name, m->kind, mesh.vertices.empty() ? std::vector<float>{} : m->make(wrapped)});
  return out;
}

}  // namespace dreampm
