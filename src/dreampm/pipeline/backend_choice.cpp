#include "dreampm/pipeline/backend_choice.h"

#include <fmt/format.h>

#include "dreampm/base/error.h"
#include "dreampm/io/run_record.h"
#include "dreampm/pipeline/checkpoint_writer.h"

namespace dreampm {
namespace fs = std::filesystem;

std::string BackendChoice::text() const { return fmt::format("{} ({})", backend, isa); }

std::optional<BackendChoice> earlier_choice(const fs::path& folder) {
  // What cannot be read is reported by those who go on from it.
  for (const fs::path& file : checkpoints_in(folder / "checkpoint")) try {
      const CheckpointInfo info = checkpoint_info(file);
      return BackendChoice{info.backend, info.isa};
    } catch (const InputError&) {
      continue;
    }
  if (fs::exists(folder / "run.json")) try {
      const RunRecord record = RunRecord::load(folder / "run.json");
      return BackendChoice{record.backend, record.machine.isa};
    } catch (const InputError&) {
      return std::nullopt;
    }
  return std::nullopt;
}

namespace {

AnyBackend make_as_before(const BackendChoice& asked, const BackendChoice& earlier) {
  try {
    return make_backend(earlier.backend, asked.isa == "auto" ? earlier.isa : asked.isa);
  } catch (const InputError& e) {
    if (asked.isa != "auto") throw;
    fail_input(
        "{}; what is there was computed by {}: dreampm run --resume goes on with another --backend or --isa, the same "
        "to rounding",
        e.what(), earlier.text());
  }
}

}  // namespace

AnyBackend make_chosen(const BackendChoice& asked, const std::optional<BackendChoice>& earlier) {
  const bool goes_on = earlier && (asked.backend.empty() || asked.backend == earlier->backend);
  AnyBackend made = goes_on ? make_as_before(asked, *earlier) : make_backend(asked.backend, asked.isa);
  const BackendChoice now = std::visit([](const auto& backend) { return choice_of(*backend); }, made);
  if (asked.isa != "auto" && asked.isa != now.isa)
    fail_input("the instruction set {} is one of the backend cpu: leave it out with {}", asked.isa, now.backend);
  return made;
}

}  // namespace dreampm
