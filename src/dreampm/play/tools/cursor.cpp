#include "dreampm/play/tools/cursor.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "dreampm/gl/pick.h"
#include "dreampm/play/tools/wall_face.h"
#include "dreampm/scene/description.h"

namespace dreampm::play {
namespace {

constexpr double no_move = 1e-9;
/// m/s: a hand that is faster pushes as if it were this fast.
constexpr double fastest_push = 5;
/// m/s, of a jet.
constexpr double jet_speed = 1.5;

Vec3d ray_at(const gl::Ray& ray, double t) {
  return static_cast<Vec3d>(ray.origin) + static_cast<Vec3d>(ray.direction) * t;
}

Vec3d clamped(const Vec3d& p, const Box3d& box, double margin) {
  const Vec3d m{margin, margin, margin};
  return max(box.min + m, min(box.max - m, p));
}

}  // namespace

Hit pick(const Frame& frame, const gl::Ray& ray) {
  std::optional<float> nearest;
  for (const MatterFrame& m : frame.matter)
    if (const auto t = gl::first_sphere(ray, m.position, static_cast<float>(frame.spacing));
        t && (!nearest || *t < *nearest))
      nearest = t;
  for (const BodyFrame& b : frame.bodies) {
    if (!b.rigid) continue;
    const gl::Ray own{static_cast<Vec3f>(b.pose.inverse(static_cast<Vec3d>(ray.origin))),
                      static_cast<Vec3f>(b.pose.rotation.inverse()(static_cast<Vec3d>(ray.direction)))};
    if (const auto t = gl::first_triangle(own, b.mesh->vertices, b.mesh->triangles); t && (!nearest || *t < *nearest))
      nearest = t;
  }
  if (nearest) return {ray_at(ray, static_cast<double>(*nearest)), true};
  const auto direction = static_cast<Vec3d>(ray.direction);
  if (const double t = (frame.domain.min.y - static_cast<double>(ray.origin.y)) / direction.y;
      std::isfinite(t) && t > 0)
    if (const Vec3d at = ray_at(ray, t); at.x >= frame.domain.min.x && at.x <= frame.domain.max.x &&
                                         at.z >= frame.domain.min.z && at.z <= frame.domain.max.z)
      return {at, false};
  const Vec3d to_middle = frame.domain.center() - static_cast<Vec3d>(ray.origin);
  const double depth = length(to_middle);
  const double share = dot(direction, to_middle) / depth;
  return {clamped(ray_at(ray, depth / std::max(share, 0.1)), frame.domain, frame.spacing), false};
}

Vec3d above(const Hit& hit, const Box3d& domain, double size, double spacing) {
  return clamped({hit.at.x, domain.min.y + 0.75 * domain.size().y, hit.at.z}, domain, 0.55 * size + spacing);
}

/// What a drag with the left button does.
struct Cursor::Tool {
  std::string_view name;
  bool needs_matter;  ///< else it works on emptiness too; where it does not, a drag turns the camera
  void (*press)(Cursor&);
  void (*drag)(Cursor&);
  void (*release)(Cursor&);
  bool takes_walls = false;  ///< in place of matter
};

const std::vector<Cursor::Tool>& Cursor::tools() {
  const auto nothing = [](Cursor&) {};
  const auto grab = [](Cursor& p) { p.post("grab", {p.hit_->at.x, p.hit_->at.y, p.hit_->at.z, p.radius_}); };
  const auto pull = [](Cursor& p) {
    const Vec3d to = clamped(p.on_drag_plane(), p.domain_, p.spacing_);
    p.post("pull", {to.x, to.y, to.z});
  };
  const auto let_go = [](Cursor& p) { p.post("release", {}); };
  const auto erase = [](Cursor& p) {
    if (p.hit_ && p.hit_->matter) p.post("erase", {p.hit_->at.x, p.hit_->at.y, p.hit_->at.z, p.radius_});
  };
  const auto begin_pour = [](Cursor& p) { p.begin_pour(); };
  const auto pour = [](Cursor& p) { p.pour(); };
  const auto stop = [](Cursor& p) { p.post("pour", {}, "off"), p.pour_at_.reset(); };
  const auto drop = [](Cursor& p) {
    if (!p.hit_) return;
    const Vec3d room = p.domain_.size();
    const double least = std::min(least_drop(p.drop_) * p.spacing_, 0.8 * std::min(room.x, room.z));
    const double size = std::max(2 * p.radius_, least);
    const Vec3d at = above(*p.hit_, p.domain_, size, p.spacing_);
    p.post("drop", {at.x, at.y, at.z, size}, p.drop_);
  };
  const auto cut = [](Cursor& p) {
    // The plane through the eye and both ends of the drag.
    const gl::Ray a = p.seen_by().ray(static_cast<float>(p.drag_x_), static_cast<float>(p.drag_y_), p.width_,
                                      p.height_),
                  b = p.seen_by().ray(static_cast<float>(p.x_), static_cast<float>(p.y_), p.width_, p.height_);
    const Vec3d normal = static_cast<Vec3d>(cross(a.direction, b.direction));
    if (length(normal) < 1e-3) return;
    const Vec3d middle = p.domain_.center();
    const Vec3d n = normalized(normal);
    const Vec3d at = middle - n * dot(middle - static_cast<Vec3d>(a.origin), n);
    p.post("cut", {at.x, at.y, at.z, n.x, n.y, n.z, length(p.domain_.size())});
    p.post("release", {});
  };
  const auto wall = [](Cursor& p) { p.draw_wall(); };
  const auto pin = [](Cursor& p) { p.post("pin", {p.hit_->at.x, p.hit_->at.y, p.hit_->at.z, p.radius_}); };
  static const std::vector<Tool> all{
      {"push", true, grab, pull, let_go},      {"grab", true, grab, pull, let_go},
      {"pour", false, begin_pour, pour, stop}, {"drop", false, drop, nothing, nothing},
      {"cut", false, nothing, nothing, cut},   {"erase", true, erase, erase, let_go},
      {"pin", true, pin, nothing, nothing},    {"walls", true, nothing, wall, let_go, true},
  };
  return all;
}

const Cursor::Tool& Cursor::tool(const Frame& frame) const {
  return tools().at(chosen_.value_or(static_cast<std::size_t>(frame.settings.tool)));
}

const Cursor::Tool& Cursor::tool(std::string_view name) {
  return *std::find_if(tools().begin(), tools().end(), [&](const Tool& t) { return t.name == name; });
}

void Cursor::post(std::string verb, std::vector<double> numbers, std::string word) {
  Action action{std::move(verb), {}};
  if (!word.empty()) action.words.push_back(std::move(word));
  for (const double n : numbers) action.words.push_back(text_of(n));
  post_(std::move(action));
}

gl::Camera Cursor::seen_by() const {
  gl::Camera wide = camera;
  wide.view_angle = 2 * std::atan(std::tan(camera.view_angle / 2) * static_cast<float>(widen_));
  return wide;
}

Vec3d Cursor::on_drag_plane() const {
  const gl::Ray ray = seen_by().ray(static_cast<float>(x_), static_cast<float>(y_), width_, height_);
  const Vec3d forward = static_cast<Vec3d>(camera.axes().forward), eye = static_cast<Vec3d>(camera.eye);
  const double depth = dot(drag_from_ - eye, forward);
  return ray_at(ray, depth / std::max(dot(static_cast<Vec3d>(ray.direction), forward), 1e-3));
}

Vec3d Cursor::on_pour_plane() const {
  const gl::Ray ray = seen_by().ray(static_cast<float>(x_), static_cast<float>(y_), width_, height_);
  const double t = (pour_at_->y - static_cast<double>(ray.origin.y)) / static_cast<double>(ray.direction.y);
  // Of a ray that misses the plane within the box, or goes up, the jet stays where it is.
  if (!(std::isfinite(t) && t > 0)) return *pour_at_;
  Vec3d at = clamped(ray_at(ray, t), domain_, spacing_);
  at.y = pour_at_->y;
  return at;
}

void Cursor::begin_pour() {
  if (hit_) pour_at_ = hit_->at, pour();
}

void Cursor::pour() {
  if (!pour_at_) return;
  pour_at_ = on_pour_plane();
  const double height = std::min(domain_.max.y - 2 * spacing_, pour_at_->y + 0.4 * domain_.size().y);
  const double radius = std::max(0.5 * radius_, least_jet * spacing_);
  const Vec3d at = clamped({pour_at_->x, height, pour_at_->z}, domain_, radius + spacing_);
  post("pour", {at.x, at.y, at.z, radius, 0, -jet_speed, 0});
}

Hit Cursor::pick_for(const Tool& tool, const Frame& frame, const gl::Ray& ray) {
  if (!tool.takes_walls) return pick(frame, ray);
  const std::optional<WallFace> face = pick_wall(frame.room, ray);
  wall_ = face ? std::optional(face->side) : std::nullopt;
  return face ? Hit{face->at, true} : Hit{pick(frame, ray).at, false};
}

void Cursor::draw_wall() {
  if (!wall_) return;
  const gl::Ray ray = seen_by().ray(static_cast<float>(x_), static_cast<float>(y_), width_, height_);
  const std::optional<double> to = drawn_to(*wall_, drag_from_, ray);
  if (!to) return;
  const auto side = static_cast<std::size_t>(*wall_);
  const int axis = static_cast<int>(side) / 2;
  const double least = least_room * domain_.size()[axis];
  // Within what the verb takes.
  const double at = side % 2 ? std::clamp(*to, std::min(room_.min[axis] + least, domain_.max[axis]), domain_.max[axis])
                             : std::clamp(*to, domain_.min[axis], std::max(room_.max[axis] - least, domain_.min[axis]));
  post("wall", {at}, scene::wall_names.at(side));
}

void Cursor::move(const Frame& frame, double x, double y, double time) {
  const double seconds = std::max(time - time_, 1e-3);
  x_ = x, y_ = y, time_ = time;
  radius_ = frame.settings.radius, spacing_ = frame.spacing, domain_ = frame.domain;
  drop_ = drop_names()[static_cast<std::size_t>(frame.settings.drop)];
  const double dx = x - last_x_, dy = y - last_y_;
  last_x_ = x, last_y_ = y;
  const bool still = std::abs(dx) + std::abs(dy) < no_move;
  if (orbits_) {
    camera.orbit(static_cast<float>(-dx * 4 / height_), static_cast<float>(dy * 4 / height_));
    return;
  }
  if (down_ == Button::right || down_ == Button::middle) {
    // What is under the pointer stays there.
    const double wide = std::tan(static_cast<double>(seen_by().view_angle) / 2) /
                        std::tan(static_cast<double>(camera.view_angle) / 2) / height_;
    camera.pan(static_cast<float>(-dx * wide), static_cast<float>(dy * wide));
    return;
  }
  const gl::Ray ray = seen_by().ray(static_cast<float>(x), static_cast<float>(y), width_, height_);
  room_ = frame.room;
  if (drags_matter_ && tool_->takes_walls) {
    mark_.reset();
    if (!still) draw_wall();
    return;
  }
  hit_ = pick_for(tool(frame), frame, ray);
  if (drags_matter_) {
    mark_ = CursorMark{static_cast<Vec3f>(on_drag_plane()), -camera.axes().forward, static_cast<float>(radius_)};
    if (!still) tool_->drag(*this);
    return;
  }
  Vec3f normal = hit_->matter ? -camera.axes().forward : Vec3f{0, 1, 0};
  if (tool(frame).takes_walls && wall_) {
    normal = {};
    normal[static_cast<int>(*wall_) / 2] = 1;
  }
  mark_ = CursorMark{static_cast<Vec3f>(hit_->at), normal, static_cast<float>(radius_)};
  if (pours_) {
    if (!still) pour();
    return;
  }
  // A hand that hovers over matter takes it along.
  if (down_ || tool(frame).name != std::string_view("push") || !hit_->matter || !last_hit_) {
    if (pushed_) post("release", {}), pushed_ = false;
    last_hit_ = hit_;
    return;
  }
  // In the plane of the picture: what the ray meets may jump.
  const Vec3d forward = static_cast<Vec3d>(camera.axes().forward);
  Vec3d way = hit_->at - last_hit_->at;
  way -= forward * dot(way, forward);
  velocity_ = velocity_ * 0.5 + way * (0.5 / seconds);
  if (const double speed = length(velocity_); speed > fastest_push) velocity_ *= fastest_push / speed;
  if (length(velocity_) > 0.05) {
    post("push", {hit_->at.x, hit_->at.y, hit_->at.z, radius_, velocity_.x, velocity_.y, velocity_.z});
    pushed_ = true;
  } else if (pushed_) {
    post("release", {}), pushed_ = false;
  }
  last_hit_ = hit_;
}

void Cursor::leave() {
  if (pushed_) post("release", {}), pushed_ = false;
  hit_.reset(), last_hit_.reset(), mark_.reset();
}

void Cursor::press(const Frame& frame, Button button, bool shift) {
  if (down_) return;
  down_ = button;
  drag_x_ = x_, drag_y_ = y_;
  if (pushed_) post("release", {}), pushed_ = false;
  orbits_ = button == Button::right && shift;
  if (button != Button::left || !hit_) return;
  tool_ = &tool(frame);
  if (tool_->needs_matter && !hit_->matter) {
    orbits_ = true;
    return;
  }
  drags_matter_ = true;
  drag_from_ = hit_->at;
  tool_->press(*this);
}

void Cursor::release(Button button) {
  if (down_ != button) return;
  down_.reset();
  if (drags_matter_) tool_->release(*this);
  // A click that meant the tool, and no drag.
  if (button == Button::left && orbits_ && std::hypot(x_ - drag_x_, y_ - drag_y_) < 3) missed_ = tool_->name;
  drags_matter_ = orbits_ = false;
  last_hit_.reset();
}

void Cursor::wheel(double clicks) { camera.zoom(static_cast<float>(std::pow(0.9, clicks))); }

void Cursor::hold_pour(const Frame&, bool held) {
  if (held == pours_) return;
  pours_ = held;
  if (pushed_) post("release", {}), pushed_ = false;
  if (held && !hit_) missed_ = "pour";
  if (held)
    tool("pour").press(*this);
  else
    tool("pour").release(*this);
}

}  // namespace dreampm::play
