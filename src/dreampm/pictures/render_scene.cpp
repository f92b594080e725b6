#include "dreampm/pictures/render_scene.h"

#include <algorithm>

#include "dreampm/base/error.h"
#include "dreampm/math/look_color.h"
#include "dreampm/math/srgb.h"
#include "dreampm/pictures/absorption_of.h"
#include "dreampm/render/texture_frame.h"
#include "dreampm/setup/collider_mesh.h"
#include "dreampm/surface/carry.h"

namespace dreampm {
namespace {

/// Glass displaces what a liquid's surface reaches into.
constexpr int collider_priority = 1;

/// The color that all matter of the material has, if its bodies and emitters agree.
std::optional<Vec3d> common_color(const model::Scene& scene, int material) {
  const std::string& name = scene.materials.at(static_cast<std::size_t>(material)).name;
  std::optional<Vec3d> color;
  bool any_body = false;
  for (const model::Body& b : scene.bodies) {
    if (b.material != name) continue;
    if (!b.color || (color && !(*color == *b.color))) return std::nullopt;
    color = b.color, any_body = true;
  }
  for (const model::Emitter& e : scene.emitters) {
    if (e.material != name || (any_body && !e.color)) continue;
    if (!e.color || (color && !(*color == *e.color))) return std::nullopt;
    color = e.color;
  }
  return color;
}

/// Whether it is a block of glass that lies across the whole room and beyond it, as a wall that a
/// hand drags does: what is beyond the panes is not drawn.
bool ends_at_the_panes(const model::Collider& c, const model::Look& look, const Box3d& room) {
  const auto* const box = std::get_if<BoxShape>(&c.shape.form);
  if (!box || !c.shape.center || c.shape.rotate_angle != 0 || look.type != model::LookType::dielectric) return false;
  int axes = 0;
  for (int a = 0; a < 3; ++a)
    if (const double middle = (*c.shape.center)[a], half = 0.5 * box->size[a];
        middle - half < room.min[a] && middle + half > room.max[a])
      ++axes;
  return axes >= 2;
}

Vec3f clamped(Vec3f v, const Box3d& room) {
  for (int a = 0; a < 3; ++a) v[a] = std::clamp(v[a], static_cast<float>(room.min[a]), static_cast<float>(room.max[a]));
  return v;
}

}  // namespace

bool many_colored(const model::Scene& scene, int material) {
  const std::string& name = scene.materials.at(static_cast<std::size_t>(material)).name;
  const auto has_color = [&](const auto& from) { return from.material == name && from.color; };
  return !common_color(scene, material) && (std::any_of(scene.bodies.begin(), scene.bodies.end(), has_color) ||
                                            std::any_of(scene.emitters.begin(), scene.emitters.end(), has_color));
}

Vec3f matter_color(const model::Scene& scene, int material) {
  const auto common = common_color(scene, material);
  return common ? linear_color(*common) : linear_color(material_look(scene, material));
}

MatterColors::MatterColors(const model::Scene& scene, const std::vector<BodyRecord>& bodies) {
  for (const BodyRecord& r : bodies)
    for (const model::Body& b : scene.bodies)
      if (b.name == r.name && b.color) ranges_.push_back({r.first_id, r.first_id + r.count, linear_color(*b.color)});
  for (const model::Emitter& e : scene.emitters)
    if (e.color) emitters_[e.name] = linear_color(*e.color);
}

const Vec3f* MatterColors::of(const ParticleFrame& frame, std::size_t i) const {
  const auto id = static_cast<std::uint64_t>(frame.id[i]);
  const auto range =
      std::upper_bound(ranges_.begin(), ranges_.end(), id, [](std::uint64_t x, const Range& r) { return x < r.end; });
  if (range != ranges_.end() && id >= range->first) return &range->color;
  if (emitters_.empty()) return nullptr;
  const auto source = frame.columns.find("source");
  if (source == frame.columns.end())
    fail_input(
        "the particles have no column source, which gives the colors of emitters: simulate again with this scene");
  if (source->second[i] < 0) return nullptr;
  const auto emitter = emitters_.find(frame.source_names.at(static_cast<std::size_t>(source->second[i])));
  return emitter != emitters_.end() ? &emitter->second : nullptr;
}

std::vector<Vec3f> particle_colors(const model::Scene& scene, int material, const ParticleFrame& frame,
                                   const std::vector<BodyRecord>& bodies) {
  const std::string& name = scene.materials[std::size_t(material)].name;
  const Vec3f plain = matter_color(scene, material);
  const MatterColors own_colors(scene, bodies);
  std::vector<Vec3f> colors;
  for (std::size_t i = 0; i < frame.size(); ++i) {
    if (frame.material_names.at(frame.material[i]) != name) continue;
    const Vec3f* const own = own_colors.of(frame, i);
    colors.push_back(own ? *own : plain);
  }
  return colors;
}

std::vector<Vec3f> vertex_colors(const TriMesh& mesh, std::span<const Vec3f> positions, std::span<const Vec3f> colors,
                                 float spacing, Mixing mixing) {
  if (mesh.vertices.empty()) return {};
  return surface::carry_colors(mesh.vertices, {positions, spacing}, colors, mixing);
}

Mixing mixing_of(const model::Look& look) {
  return look.type == model::LookType::dielectric ? Mixing::clear : Mixing::opaque;
}

ColliderModels::ColliderModels(const model::Scene& scene, const Vec3d& shift) : shift_(shift) {
  const Box3d room{scene.space.min, scene.space.end()};
  const Meshes files(Meshes::Say::keep);
  for (const model::Collider& c : scene.colliders) {
    const model::Look& look = scene.render.looks.at(c.name);
    TriMesh mesh;
    if (!c.pin)
      mesh = collider_mesh(c.shape, 0.5 * scene.space.dx(), room, shift, c.thickness,
                           look.type == model::LookType::dielectric);
    std::optional<Vec3f> grain;
    if (look.grain) grain = static_cast<Vec3f>(*look.grain);
    const TextureFrame frame = texture_frame(mesh, grain);
    models_.push_back(
        {ColliderInTime(c, scene.space, files), std::move(mesh), look, frame, cut_of(scene, c.name, shift)});
    if (!ends_at_the_panes(c, look, room)) continue;
    models_.back().within = Box3d{room.min - shift, room.max - shift};
  }
}

std::optional<CutPlane> cut_of(const model::Scene& scene, const std::string& name, const Vec3d& shift) {
  const auto& cut = scene.render.cut;
  if (!cut || std::find(cut->of.begin(), cut->of.end(), name) == cut->of.end()) return std::nullopt;
  return CutPlane{cut->point - shift, normalized(cut->normal)};
}

TriMesh ColliderModels::mesh(std::size_t collider, double time) const {
  const Model& m = models_[collider];
  return m.in_time.sequence() ? m.in_time.sequence()->mesh(time, shift_) : m.mesh;
}

TriMesh ColliderModels::mesh_within(std::size_t collider, const Pose& pose) const {
  TriMesh mesh = this->mesh(collider);
  if (!models_[collider].within) return mesh;
  for (Vec3f& v : mesh.vertices) {
    const Vec3f in = clamped(placed(pose, v), *models_[collider].within);
    v = static_cast<Vec3f>(pose.inverse(static_cast<Vec3d>(in) + shift_) - shift_);
  }
  return mesh;
}

std::vector<Pose> ColliderModels::poses_in(const FrameRecord& frame) const {
  std::vector<Pose> poses;
  for (const Model& m : models_) poses.push_back(m.in_time.pose_in(frame));
  return poses;
}

namespace {

/// Where a body is that goes from pose a to pose b, a share s of the way; its middle goes straight.
Pose between(const Pose& a, const Pose& b, const Vec3d& middle, double s) {
  const Vec3d turn = MotionPath::rotation_vector(b.rotation * a.rotation.inverse());
  const Quaternion rotation = Quaternion::about(turn * s) * a.rotation;
  return {a(middle) * (1 - s) + b(middle) * s - rotation(middle), rotation};
}

double turn_between(const Pose& a, const Pose& b) {
  return length(MotionPath::rotation_vector(b.rotation * a.rotation.inverse()));
}

}  // namespace

ColliderMotion ColliderModels::motion_about(const FrameRecord& frame, const FrameRecord* before,
                                            const FrameRecord* after, double open) const {
  ColliderMotion out{open, {}};
  if (!(open > 0)) return out;
  const std::vector<Pose> now = poses_in(frame);
  const auto pose_at = [&](std::size_t c, double t) {
    const Model& m = models_[c];
    const std::string& name = m.in_time.name();
    if (!frame.poses.contains(name)) return m.in_time.pose_at(t);
    const auto has = [&](const FrameRecord* f) { return f != nullptr && f->poses.contains(name); };
    const bool forward = has(after) && (t >= frame.time || !has(before));
    const FrameRecord* other = forward ? after : before;
    if (!has(other) || other->time == frame.time) return now[c];
    const Vec3d middle = static_cast<Vec3d>(m.frame.middle) + shift_;
    return between(now[c], other->poses.at(name), middle, (t - frame.time) / (other->time - frame.time));
  };
  constexpr double step_turn = 0.1;  // rad: what turns is drawn along chords
  double most = 0;
  for (std::size_t c = 0; c < models_.size(); ++c)
    most = std::max(most, turn_between(pose_at(c, frame.time - 0.5 * open), pose_at(c, frame.time + 0.5 * open)));
  // An even number of steps has one in the middle, where a deforming mesh comes to its next file.
  const int steps = 2 * std::clamp(static_cast<int>(std::ceil(0.5 * most / step_turn)), 1, 16);
  for (int k = 0; k <= steps; ++k) {
    std::vector<Pose>& poses = out.poses.emplace_back();
    const double t = frame.time + open * (static_cast<double>(k) / steps - 0.5);
    for (std::size_t c = 0; c < models_.size(); ++c) poses.push_back(2 * k == steps ? now[c] : pose_at(c, t));
  }
  return out;
}

TriMesh ColliderModels::standing(std::size_t c, const Pose& pose, double time) const {
  TriMesh mesh = this->mesh(c, time);
  if (!(pose == Pose{})) {
    for (Vec3f& v : mesh.vertices) v = placed(pose, v);
    for (Vec3f& n : mesh.normals) n = static_cast<Vec3f>(pose.rotation(static_cast<Vec3d>(n)));
  }
  if (models_[c].within)
    for (Vec3f& v : mesh.vertices) v = clamped(v, *models_[c].within);
  return mesh;
}

void ColliderModels::add_motion(std::size_t c, double time, const ColliderMotion& motion, TriMesh& mesh,
                                RenderObject& object, std::list<TriMesh>& steps) const {
  const std::size_t count = motion.poses.size();
  if (count < 2) return;
  const Pose& first = motion.poses.front()[c];
  const bool still =
      std::all_of(motion.poses.begin(), motion.poses.end(), [&](const auto& p) { return p[c] == first; });
  if (still && !deforms(c)) return;
  for (std::size_t k = 0; k < count; ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(count - 1) - 0.5;
    object.motion.push_back(&steps.emplace_back(standing(c, motion.poses[k][c], time + share * motion.open)));
  }
  const std::vector<Vec3f>&from = object.motion.front()->vertices, &to = object.motion.back()->vertices;
  mesh.velocities.resize(mesh.vertices.size());
  for (std::size_t v = 0; v < mesh.velocities.size(); ++v)
    mesh.velocities[v] = (to[v] - from[v]) / static_cast<float>(motion.open);
}

DrawnColliders ColliderModels::at(std::span<const Pose> poses, double time, const ColliderMotion& motion) const {
  DrawnColliders out;
  for (std::size_t c = 0; c < models_.size(); ++c) {
    TriMesh& mesh = out.meshes.emplace_back(standing(c, poses[c], time));
    if (mesh.triangles.empty()) continue;
    RenderObject object{&mesh, models_[c].look, {}, models_[c].frame, collider_priority};
    if (const Pose& pose = poses[c]; !(pose == Pose{})) {
      const auto turn = [&](const Vec3f& d) { return static_cast<Vec3f>(pose.rotation(static_cast<Vec3d>(d))); };
      TextureFrame& frame = object.frame;
      frame.middle = placed(pose, frame.middle);
      frame.x = turn(frame.x), frame.y = turn(frame.y), frame.z = turn(frame.z);
    }
    if (models_[c].cut) {
      std::vector<Vec3f> no_colors;
      cut_mesh(mesh, no_colors, *models_[c].cut);
      if (mesh.triangles.empty()) continue;
    } else {
      add_motion(c, time, motion, mesh, object, out.steps);
    }
    out.objects.push_back(std::move(object));
  }
  return out;
}

model::Look material_look(const model::Scene& scene, int material) {
  model::Look look = scene.render.looks.at(scene.materials[std::size_t(material)].name);
  if (const auto common = common_color(scene, material)) {
    look.color = *common;
    if (is_clear(look)) look.absorption = absorption_of(linear_color(*common));
  }
  return look;
}

}  // namespace dreampm
