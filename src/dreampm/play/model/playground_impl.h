// What a playground is made of. For the files of this module alone.
#pragma once
#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dreampm/play/model/ages.h"
#include "dreampm/play/model/playground.h"
#include "dreampm/play/model/rendering.h"
#include "dreampm/scene/description.h"

namespace dreampm::play {

/// What a hand holds: matter, which a brush draws to where the hand is, or a rigid body, which a
/// spring does.
struct Grab {
  Vec3d hand;    ///< m
  Vec3d middle;  ///< m, of the matter that is held; of a body where the spring ends
  double radius;
  std::string body = {};  ///< name; empty: matter
  Vec3d at{};             ///< m, of the body's shape: where it is held
};

/// Ticks are drawn frames.
inline constexpr double ticks_a_second = 60;

/// 1/s at strength 1: how fast what is pushed takes on the velocity of the hand.
inline constexpr double push_rate = 60;

/// Pins are brushes of the simulation that stand still, by name.
using Pins = std::vector<std::pair<std::string, Stroke>>;
Pins pins_of(const Simulation& simulation);
/// Those of a saved scene, which are fields there. They are taken out of it: pins of a playground
/// can be let go.
Pins take_pins(Scene& scene);

/// 1/s: how fast what is pinned comes to rest.
inline constexpr double pin_rate = 1e4;

/// A hand that takes along what it moves through.
struct Push {
  Vec3d at, velocity;
  double radius;
};

/// A jet that comes out of the hand.
struct Pour {
  Vec3d at, velocity;
  double radius;
  double travelled = 0;          ///< m
  std::optional<double> seen{};  ///< s: until when it has come out; absent: it begins
};

/// What left by open walls; sides count as in Side.
struct Losses {
  std::array<std::uint64_t, 6> gone{};  ///< particles, of late
  std::array<std::uint64_t, 6> all{};   ///< and since the stage was opened
  std::array<std::uint64_t, 6> out{};   ///< that are beyond the walls now
  std::uint64_t seen = 0;               ///< gone so far, by the world's own count
  double last = 0, said = -1;           ///< s of playing: when some were lost, and when it was said
  bool unsaid = false;
};
/// "1,200 particles left by the top"; empty where none did.
std::string lost_text(const std::array<std::uint64_t, 6>& by_side);

/// As shapes are turned in scenes: degrees about an axis.
struct Turn {
  Vec3d axis;
  double angle;
};
/// From the y axis to `direction`, a unit vector.
Turn turn_to(const Vec3d& direction);

/// Of the collider that stands for a wall that was dragged; sides count as in Side.
std::string wall_name(std::size_t side);

/// How a scene is saved.
struct SavedAs {
  bool finer = false;             ///< at half the spacing, each particle as eight
  std::optional<double> seconds;  ///< that it lasts; absent: as long as the scene it came from
  /// From where it is seen; absent: from where that was.
  struct Seen {
    Vec3d from, to;  ///< m
    double fov;      ///< degrees
  };
  std::optional<Seen> seen;
};

/// A stage, and how it begins.
struct LoadedScene {
  PlayScene stage;
  Snapshot start;
};

/// What is made of what is shown: one film at a time, of whichever side is chosen.
struct Films {
  std::optional<Rendering> rendering;
  std::string file;  ///< that what is shown is filmed into, by whoever shows it; empty: none
  double fps = 60;
};

struct ReportLook;

/// How matter looks whose scene says so.
MatterLook look_of(const scene::Look& look);

struct Playground::Impl {
  Impl(PlayScene stage, const PlayOptions& options);

  const PlayScene& play_scene() const { return opened->stage; }

  // playground.cpp
  /// A stage with its simulation, whose pins hold.
  struct Begun {
    PlayScene stage;
    Simulation simulation;
  };
  /// Throws InputError for a scene that cannot start.
  Begun begin(PlayScene stage) const;
  void open(Begun next);
  /// Makes the simulation one of that stage, and forgets what hands did.
  void enter(std::shared_ptr<const LoadedScene> what, Simulation fresh);
  void restart();
  /// After a jump to another moment: what hands had begun has ended.
  void let_go();
  StateSnapshot moment() const { return {opened, simulation->snapshot(), settings, played}; }
  void go_to(const StateSnapshot& moment);
  /// Keeps what is now for undo.
  void before_edit(const std::string& what) {
    history.before_edit(what, [this] { return moment(); });
  }
  void say(std::string text, bool is_error = false) {
    message = std::move(text), message_is_error = is_error, ++message_number;
  }
  /// s of simulated time that a tick asks for
  double asked_seconds() const;
  int advance(const Limit& limit);
  /// Steps that it took. Where numbers stop being numbers the world jumps back.
  int tick(const Limit& limit);
  /// Goes back from what went wrong in a tick that began at that step; the steps that it took.
  int fail(std::uint64_t before_steps, const std::string& why);
  enum class Jump { none, back, anew };
  void jump(Jump where, const std::string& why);

  // materials.cpp
  /// Lists the controls anew, where the materials of the scene are others.
  void list_controls();
  double value_of(const ControlInfo& control);
  /// Of all controls, as they were asked for: what is under way is at its end.
  std::vector<double> asked_values();
  /// Says where elastic matter has become too soft for what presses on it, which it was not as all
  /// was set before.
  void see_softness(const std::vector<double>& before);
  void set(const std::string& id, double value);
  /// A parameter of a material, by the id of its control, at once.
  void set_material(const std::string& id, double value);
  /// Of the report's material.
  void take_look(const ReportLook& look);
  /// Moves the materials on to what was asked for, no faster than the matter can take.
  void approach_targets();
  /// The name of the material of that kind; the scene gets it where it has none.
  std::string ensure_matter(std::size_t kind);
  std::vector<std::string> facts() const;
  /// The member of a look that a control of a material sets; null for other controls.
  float* look_member(const std::string& id);
  std::string remedy() const;

  // compare.cpp
  /// Goes on where `other` is, but for its past, with that kind of matter in place of its main one.
  void copy(const Impl& other, std::optional<std::size_t> kind);
  /// The material of which there is most.
  std::string main_material() const;
  /// The hand has the matter of the scene, and what it is compared with is another.
  void choose_matter();
  /// That kind of matter takes the place of the material `stand_in_for`.
  void put_stand_in();

  // hand.cpp
  void apply_hand(double seconds);
  void pour_jet();

  // pins.cpp
  /// Matter within the stroke is held where it is.
  void pin(const Stroke& hold);
  /// All of them.
  void let_pins_go();
  std::vector<PinFrame> pins() const;

  // bodies.cpp
  /// One of drop_names(), or a file of a mesh.
  void drop(const std::string& name, const Vec3d& at, double size);
  /// The rigid body whose surface is there; empty: none.
  std::string body_at(const Vec3d& at) const;
  void take_hold(const Vec3d& at, double radius);
  void hold_body();
  /// Takes the rigid bodies along that the hand which pushes touches.
  void push_bodies();
  /// Takes out the matter around, and the rigid body there.
  void erase(const Vec3d& at, double radius);

  // walls.cpp
  /// m, along its axis: where the inner face of a wall is.
  double wall_at(std::size_t side) const;
  bool has_slab(std::size_t side) const;
  /// Between the walls.
  Box3d room() const;
  /// A wall begins to move to that place [m]. Throws InputError.
  void draw_wall(std::size_t side, double to);
  void move_walls();
  /// Whether walls may not come further inward, for liquid fills what is between them.
  bool is_full() const;
  void stop_walls();
  /// As it is drawn; nothing where it was not dragged.
  std::optional<BodyFrame> wall_plane(std::size_t side) const;

  // losses.cpp
  /// Says what left since the last call.
  void see_losses();
  /// After a jump to another moment.
  void forget_losses();

  // save.cpp
  /// A scene file, and beside it the moment that it starts from.
  void save(const std::filesystem::path& file, const SavedAs& as = {});
  /// Saves a finer scene and begins an estimate of its film, or the film itself: the words of the
  /// verbs `estimate` and `render`.
  void render(const Action& action, bool goes_on);
  // readback.cpp
  /// Notes what came in since the last call.
  void see_new_matter();
  void read(Frame& frame);
  std::shared_ptr<Frame> frame();

  PlayOptions options;
  std::shared_ptr<const LoadedScene> opened;
  std::optional<Simulation> simulation;
  Settings settings;
  History history;
  double played = 0;         ///< s
  double owed = 0;           ///< s of simulated time that were asked for and are not done
  Jump jumped = Jump::none;  ///< in the last tick
  bool single_step = false;
  bool restart_is_due = false;
  std::map<std::string, double> targets;  ///< of material controls that are under way
  std::shared_ptr<const std::vector<ControlInfo>> controls;
  std::vector<std::string> refusals;  ///< of each kind of matter by the solver; empty: it can do with it
  std::string no_other;               ///< why the stage cannot be moved by the other solver; empty: it can
  Vec3d gravity;                      ///< m/s^2, that the simulation has
  Vec3d shake{};                      ///< m/s^2, besides; fades
  std::optional<Grab> grab;
  std::optional<Pour> pour;
  std::optional<Push> push;
  std::array<std::optional<double>, 6> walls;  ///< m: where those go that are under way
  int drops = 0;                               ///< made so far
  int failures = 0;                            ///< since matter last moved well
  Losses losses;
  double pushed = 0;  ///< s of playing: when a hand pushed last
  Meters meters;
  double step_seconds = 1e-3;    ///< of the wall clock, each
  double mean_step_seconds = 0;  ///< the same over about a second; 0: none was taken
  std::vector<LiveRange> live;   ///< of the controls `live_of`, as it was at the tick `live_at`
  std::shared_ptr<const std::vector<ControlInfo>> live_of;
  std::uint64_t live_at = 0;
  std::uint64_t actions = 0, ticks = 0;
  Ages ages;
  std::optional<std::uint32_t> seen_until;  ///< the id of the next particle, when ages saw all; absent: they did not
  std::shared_ptr<Films> films = std::make_shared<Films>();
  std::string message;
  bool message_is_error = false;
  std::uint64_t message_number = 0;
  /// While materials are compared: what this side is called after, and the kind of matter that is
  /// there instead of another material.
  std::string main;
  std::string stand_in_for;
  std::optional<std::size_t> stand_in;
  std::map<std::string, MatterLook> looks;     ///< by the name of the material
  std::vector<BodyFrame> bodies;               ///< where the scene has them
  std::vector<std::shared_ptr<Frame>> frames;  ///< that were given away, to be used again
};

}  // namespace dreampm::play
