// The backend of a run: the one that is asked for, else the one that wrote what it goes on from.
#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "dreampm/backend/registry.h"

namespace dreampm {

/// A backend and its instruction set, by their names.
struct BackendChoice {
  std::string backend;       ///< empty: no wish
  std::string isa = "auto";  ///< auto: no wish

  /// "cpu (avx2)".
  std::string text() const;
  bool operator==(const BackendChoice&) const = default;
};

template <class R>
BackendChoice choice_of(const Backend<R>& backend) {
  return {std::string(backend.name()), std::string(backend.isa())};
}

/// What computed the newest checkpoint of a run that can be read, or the run, where it has none.
/// Nothing in a folder without a run.
std::optional<BackendChoice> earlier_choice(const std::filesystem::path& folder);

/// Makes the backend that is asked for. What is not asked for is as in `earlier`, which a run goes
/// on from: then it has the same bits. Throws InputError where this machine cannot run it, and says
/// by which options another one goes on.
AnyBackend make_chosen(const BackendChoice& asked, const std::optional<BackendChoice>& earlier);

}  // namespace dreampm
