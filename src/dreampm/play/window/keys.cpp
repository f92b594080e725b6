#include "dreampm/play/window/keys.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <array>
#include <string_view>
#include <utility>

#include "dreampm/play/window/app.h"

namespace dreampm::play {
namespace {

constexpr std::array<std::pair<int, Key>, 15> named{{{GLFW_KEY_ESCAPE, Key::escape},
                                                     {GLFW_KEY_ENTER, Key::enter},
                                                     {GLFW_KEY_KP_ENTER, Key::enter},
                                                     {GLFW_KEY_TAB, Key::tab},
                                                     {GLFW_KEY_BACKSPACE, Key::backspace},
                                                     {GLFW_KEY_DELETE, Key::remove},
                                                     {GLFW_KEY_LEFT, Key::left},
                                                     {GLFW_KEY_RIGHT, Key::right},
                                                     {GLFW_KEY_UP, Key::up},
                                                     {GLFW_KEY_DOWN, Key::down},
                                                     {GLFW_KEY_HOME, Key::home},
                                                     {GLFW_KEY_END, Key::end},
                                                     {GLFW_KEY_F1, Key::f1},
                                                     {GLFW_KEY_F6, Key::f6},
                                                     {GLFW_KEY_F12, Key::f12}}};

bool is_small_letter(char c) { return c >= 'a' && c <= 'z'; }

}  // namespace

int key_of(int key, const char* name) {
  for (const auto& [theirs, ours] : named)
    if (key == theirs) return static_cast<int>(ours);
  // GLFW's numbers of printable keys are ASCII; the others would be taken for names of Key.
  if (key < ' ' || key > 126) return 0;
  if (key >= '0' && key <= '9') return key;
  const std::string_view sign = name ? name : "";
  if (sign.size() == 1 && is_small_letter(sign[0])) return sign[0] - 'a' + 'A';
  if (sign == "[" || sign == "]" || sign == ".") return sign[0];
  return key >= 'A' && key <= 'Z' && !sign.empty() ? 0 : key;
}

}  // namespace dreampm::play
