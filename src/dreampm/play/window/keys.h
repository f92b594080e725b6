// GLFW's keys as the playground's.
#pragma once

namespace dreampm::play {

/// What Input::pressed holds for that key of GLFW; 0 for keys without a meaning. Letters, brackets
/// and the period go by the character on the key, `name` (glfwGetKeyName: may be null), digits and
/// other signs by their place on an American keyboard.
int key_of(int key, const char* name);

}  // namespace dreampm::play
