// `dreampm schema`: what a scene may hold, and what a ledger has, from the tables that read them.
#pragma once
#include <string>

#include "dreampm/scene/value_info.h"

namespace dreampm::cli {

/// The page docs/reference/scene.md.
std::string scene_page();

/// The part "Columns" of docs/reference/ledger.md.
std::string ledger_page();

/// A JSON Schema (draft 2020-12) for scenes.
std::string scene_json_schema();

/// A visitor for std::visit: one function for each type.
template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;

}  // namespace dreampm::cli
