// What the playground shows: copied out of the simulation after a tick, and free to be read by
// another thread while the simulation goes on.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dreampm/geometry/mesh.h"
#include "dreampm/play/model/action.h"
#include "dreampm/play/model/control.h"
#include "dreampm/pose.h"
#include "dreampm/vec.h"

namespace dreampm::play {

/// How a material looks, of its scene.
struct MatterLook {
  bool clear = false;  ///< a liquid that one sees through
  bool grains = false;
  float ball = 0;                    ///< spacings: the radius of balls that are drawn as such; 0: none
  Vec3f color{0.75f, 0.75f, 0.78f};  ///< sRGB, 0 to 1
  Vec3f absorption{};                ///< 1/m, of clear ones
  float refractive_index = 1.333f;
  float opacity = 1;  ///< of all but clear ones

  bool operator==(const MatterLook&) const = default;
};

struct MatterFrame {
  std::string name;
  std::shared_ptr<const MatterLook> look;
  std::vector<Vec3f> position;                     ///< m
  std::vector<float> value;                        ///< what it is colored by; empty: by its material
  std::vector<std::array<std::uint8_t, 4>> color;  ///< red green blue alpha, where each has its own
};

/// Foam, one a ball.
struct FoamSprites {
  std::vector<Vec3f> position;                     ///< m
  std::vector<float> radius;                       ///< m
  std::vector<std::array<std::uint8_t, 4>> color;  ///< red green blue, and the share that it hides

  std::size_t size() const { return position.size(); }
};

/// A collider or a rigid body.
struct BodyFrame {
  std::string name;
  bool rigid = false;
  std::shared_ptr<const TriMesh> mesh;
  Pose pose;
  Vec3f color;
  float opacity = 1;
};

/// A place that a tool shows: a level circle with a cross.
struct PlaceMark {
  Vec3f at;
  float radius;  ///< m
};

/// A button that a tool has below those of all tools, as long as there is something for it.
struct ToolButton {
  std::string text;
  Action action;
};

/// How fast the world goes: what was asked for, and what was done.
struct Meters {
  double asked_dt = 0;  ///< s
  double taken_dt = 0;  ///< s, of the last step
  std::string limiter;  ///< what limited it
  std::string remedy;   ///< what would make it longer
  int substeps = 0;     ///< of the last tick
  double step_ms = 0;   ///< of the wall clock, each
  double rate = 0;      ///< simulated seconds a second, of those asked for: 1 keeps up
};

/// What a film of the present state, made beside the playground, has come to.
struct RenderStatus {
  enum class State { estimating, estimated, running, done, stopped, failed };
  State state = State::estimating;
  std::string scene;  ///< its file
  // From the estimate on.
  std::uint64_t particles = 0, disk_bytes = 0, memory_bytes = 0;
  double seconds = 0;  ///< of the wall clock, that the film will take
  // While it runs.
  std::string stage;         ///< simulate, surface, render, video; empty before the first
  int done = 0, frames = 0;  ///< of the stage
  double share = 0;          ///< of all work that is done, 0 to 1
  double left = 0;           ///< s, of the wall clock
  // In the end.
  std::string film;  ///< its file
  std::string what;  ///< went wrong, and the file that says more

  /// Whether a process works for it.
  bool under_way() const { return state == State::estimating || state == State::running; }
};

struct Frame {
  std::uint64_t number = 0;  ///< of the tick
  std::string story;         ///< name
  std::string about;
  double time = 0;  ///< s
  std::uint64_t steps = 0;
  std::size_t particles = 0;
  std::size_t size = 1;                      ///< of the scene, an index into size_names()
  bool can_resize = true;                    ///< whether it may have another one
  std::size_t solver = 0;                    ///< index into solver_names()
  std::string no_other;                      ///< why the other solver cannot do with the stage; empty: it can
  std::vector<std::string> matter_refusals;  ///< of each kind, by the solver; empty: it can do with it
  Box3d domain{};
  Box3d room{};           ///< the part of it between the walls as they were dragged
  Vec3d eye{}, target{};  ///< m: where the scene is seen from
  double view_angle = 1;  ///< rad, from the lower to the upper edge
  double spacing = 0;     ///< m
  std::vector<MatterFrame> matter;
  FoamSprites bubbles, foam;  ///< within liquids, and on and above them
  std::vector<BodyFrame> bodies;
  std::string value_label, value_unit;  ///< of the colors; empty: by material
  float value_min = 0, value_max = 1;
  Meters meters;
  Settings settings;
  std::shared_ptr<const std::vector<ControlInfo>> controls;
  std::vector<double> values;                     ///< of the controls
  std::vector<LiveRange> live;                    ///< of the controls
  std::vector<std::string> facts;                 ///< what the materials come to: E, nu, sound, viscosity
  std::vector<PlaceMark> marks;                   ///< of tools
  std::vector<ToolButton> buttons;                ///< of tools
  std::string preset_file;                        ///< of the report: the config, and its presets
  std::vector<std::string> presets;               ///< names
  std::size_t preset = 0;                         ///< which of them is played
  std::shared_ptr<const RenderStatus> rendering;  ///< null: none was asked for
  std::string film;                               ///< file that what is shown is filmed into; empty: none
  double film_fps = 60;
  double past = 0;    ///< s that can be gone back
  double future = 0;  ///< s that can be gone forward again, after going back
  bool can_undo = false, can_redo = false;
  std::string message;  ///< the last thing that was refused, mended or saved; empty: none
  bool message_is_error = false;
  std::uint64_t message_number = 0;  ///< counts messages
  std::string lost;                  ///< what left by open walls since the scene was opened; empty: nothing
  std::uint64_t actions = 0;         ///< done so far: those with lower numbers are in this frame
  /// While materials are compared: which side this is, the chosen one, 'A' or 'B', what it is
  /// called after, and the other one.
  char side = 0;
  std::string side_name;
  std::shared_ptr<const Frame> other;

  const Frame& side_a() const { return other && side == 'B' ? *other : *this; }
  const Frame& side_b() const { return other && side == 'A' ? *other : *this; }
};

}  // namespace dreampm::play
