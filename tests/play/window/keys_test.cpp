// What keys of keyboards mean.
#include "dreampm/play/window/keys.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <set>

#include "dreampm/play/window/app.h"

namespace dreampm::play::keys_test {
namespace {

TEST(Keys, LettersGoByTheCharacterOnThem) {
  EXPECT_EQ(key_of(GLFW_KEY_Z, "z"), 'Z');
  EXPECT_EQ(key_of(GLFW_KEY_Z, "y"), 'Y') << "QWERTZ";
  EXPECT_EQ(key_of(GLFW_KEY_Q, "a"), 'A') << "AZERTY";
  EXPECT_EQ(key_of(GLFW_KEY_SEMICOLON, "m"), 'M');
  EXPECT_EQ(key_of(GLFW_KEY_M, ","), 0) << "the key where M is elsewhere";
  EXPECT_EQ(key_of(GLFW_KEY_K, nullptr), 'K') << "where the system says nothing";
}

TEST(Keys, DigitsAndOtherSignsGoByTheirPlace) {
  EXPECT_EQ(key_of(GLFW_KEY_2, "\xC3\xA9"), '2') << "AZERTY has letters there";
  EXPECT_EQ(key_of(GLFW_KEY_LEFT_BRACKET, "["), '[');
  EXPECT_EQ(key_of(GLFW_KEY_LEFT_BRACKET, "\xC3\xBC"), '[') << "QWERTZ has no key for it alone";
  EXPECT_EQ(key_of(GLFW_KEY_PERIOD, "."), '.');
  EXPECT_EQ(key_of(GLFW_KEY_SPACE, nullptr), ' ');
}

TEST(Keys, WhatHasNoMeaningIsTakenForNothingElse) {
  std::set<int> meant;
  for (int key = 0; key <= GLFW_KEY_LAST; ++key)
    if (const int known = key_of(key, nullptr); known > 255) meant.insert(key);
  EXPECT_EQ(meant.size(), 15U);
  for (const int key : {GLFW_KEY_PAGE_UP, GLFW_KEY_PAGE_DOWN, GLFW_KEY_INSERT, GLFW_KEY_F5, GLFW_KEY_LEFT_SHIFT})
    EXPECT_EQ(key_of(key, nullptr), 0) << key;
  EXPECT_EQ(key_of(GLFW_KEY_KP_ENTER, nullptr), static_cast<int>(Key::enter));
}

}  // namespace
}  // namespace dreampm::play::keys_test
