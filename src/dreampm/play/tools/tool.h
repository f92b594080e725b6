// A tool of the playground: one file of this folder each, and a word in the list of tools.cpp.
#pragma once
#include <memory>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "dreampm/play/model/frame.h"
#include "dreampm/play/model/verb.h"
#include "dreampm/play/tools/gesture.h"
#include "dreampm/simulation.h"

namespace dreampm::play {

class RandomActions;

/// What is known of a tool without one.
struct ToolInfo {
  std::string_view name;      ///< of its button, and of the setting `tool`
  char key = 0;               ///< chooses it; 0: it has no button, and works by itself
  char held_key = 0;          ///< works with it while it is held, whatever tool is chosen; 0: none
  std::string_view hint{};    ///< a line for the first minute, until its first verb is used; empty: none
  bool needs_matter = false;  ///< a press beside what it takes turns the view instead
  std::vector<Verb> verbs{};  ///< what scripts can say of it, and what its drags post
  int chance = 0;             ///< how often random actions take it, of all their chances
};

/// A tool with what it remembers. The window has one set, which drags go to; each side of a
/// playground has one, which actions and ticks go to. They meet by actions alone.
class Tool {
 public:
  virtual ~Tool() = default;
  virtual std::unique_ptr<Tool> clone() const = 0;
  virtual const ToolInfo& info() const = 0;

  // ---- in the window: what drags post

  /// What it would take at that ray.
  virtual Hit pick(const Frame& frame, const gl::Ray& ray) { return play::pick(frame, ray); }
  virtual bool picks_while_dragged() const { return true; }
  /// The ring of the brush where it is; nothing: none is drawn.
  virtual std::optional<CursorMark> mark(const Gesture& g) const { return g.ring(); }
  virtual void press(Gesture&) {}
  virtual void drag(Gesture&) {}
  virtual void release(Gesture&) {}
  /// The cursor moves, and no button is pressed; then it is elsewhere, or a button is.
  virtual void hover(Gesture&) {}
  virtual void leave(Gesture&) {}

  // ---- in a playground

  /// Before the steps of a tick, which are to take that long [s].
  virtual void tick(PlayModel&, double) {}
  /// m/s^2, beside gravity.
  virtual Vec3d acceleration() const { return {}; }
  /// The verb `release`.
  virtual void end(PlayModel&) {}
  /// Whether that edit goes on after it: the next one of its name is none of its own.
  virtual bool goes_on(std::string_view) const { return false; }
  /// The world is at another moment: what was begun has ended.
  virtual void reset(PlayModel&) {}
  virtual bool holds_body() const { return false; }
  virtual void body_removed(std::string_view) {}
  /// Moves what the tool has in a scene that is opened out of it, and then into its simulation.
  virtual void load(Scene&) {}
  virtual void start(Simulation&) {}
  /// Adds to a scene that is saved what the tool has in the simulation.
  virtual void save(const Simulation&, model::Scene&) const {}
  /// What is seen of it.
  virtual void marks(const PlayModel&, Frame&) const {}
  /// Whether `marks` has that collider, in place of its mesh.
  virtual bool draws(std::string_view) const { return false; }

  /// Something that may be done with it, by chance.
  virtual Action random(RandomActions&, const Frame&) const { return {"release", {}}; }
};

/// One of each tool, in the order of the list. A copy has the state of all.
class ToolSet {
 public:
  ToolSet();
  ToolSet(const ToolSet& other);
  ToolSet(ToolSet&&) noexcept = default;
  ToolSet& operator=(const ToolSet& other) { return *this = ToolSet(other); }
  ToolSet& operator=(ToolSet&&) noexcept = default;
  ~ToolSet() = default;

  auto begin() const { return tools_.begin(); }
  auto end() const { return tools_.end(); }
  /// Null: there is none of that name.
  Tool* find(std::string_view name) const;
  /// The one of that class.
  template <class T>
  T& get() const {
    for (const auto& tool : tools_)
      if (auto* const own = dynamic_cast<T*>(tool.get())) return *own;
    throw std::logic_error("the list of tools lacks one");
  }

 private:
  std::vector<std::unique_ptr<Tool>> tools_;
};

/// Of all tools.
const std::vector<ToolInfo>& tool_infos();
/// Those that have a button: the setting `tool` counts them.
const std::vector<ToolInfo>& tool_buttons();

/// What the classes of tools derive from: `T` has a function `static ToolInfo about()`.
template <class T>
class ToolOf : public Tool {
 public:
  std::unique_ptr<Tool> clone() const override { return std::make_unique<T>(static_cast<const T&>(*this)); }
  const ToolInfo& info() const override {
    static const ToolInfo info = T::about();
    return info;
  }
};

}  // namespace dreampm::play
