// The list of cases, in the order they are run and reported.
#pragma once
#include <span>
#include <string>

#include "validate/case.h"

namespace dreampm::validate {

std::span<const Case* const> all_cases();
/// The case of that name, or InputError naming the nearest one, or all where none is near.
const Case& find_case(const std::string& name);

}  // namespace dreampm::validate
