// The page docs/validation.md: a table of all cases, then a section of each.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "validate/report.h"

namespace dreampm::validate {

/// The page with these results, `plots` being the folder of the pictures as it sees it. Sections of
/// the other cases of the list stay as they are in `before`, the page that was there, so that a
/// page can be made in pieces. Each section says which version made it.
std::string page_with(const std::vector<Result>& results, const std::string& plots, std::string_view before = {});

}  // namespace dreampm::validate
