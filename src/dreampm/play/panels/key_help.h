// What keys and drags do, in words: the page of keys, and the table of the guide.
#pragma once
#include <string>
#include <vector>

namespace dreampm::play {

struct KeyHelp {
  std::string keys, what;  ///< of the page
  std::string row;         ///< of the table of docs/guide/playground.md
};
/// Of the one list of keys (window/app_keys.cpp), which presses go by, too.
const std::vector<KeyHelp>& key_help();

}  // namespace dreampm::play
