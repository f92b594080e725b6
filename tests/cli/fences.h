// The text between the fences of a page.
#pragma once
#include <sstream>
#include <string>
#include <vector>

namespace dreampm::test {

struct Fence {
  std::string language, text;
};

inline std::vector<Fence> fences_of(const std::string& page) {
  std::vector<Fence> fences;
  std::istringstream lines(page);
  bool inside = false;
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with("```")) {
      inside = !inside;
      if (inside) fences.push_back({line.substr(3), ""});
    } else if (inside) {
      fences.back().text += line + "\n";
    }
  return fences;
}

}  // namespace dreampm::test
