// The state of a world in an archive, and back: the same bits. What a scene gives is not in it.
#pragma once
#include <cstdint>
#include <string>

#include "dreampm/io/archive.h"
#include "dreampm/state/world.h"

namespace dreampm {

template <class R>
void write_world(ArchiveWriter& to, const World<R>& world);

/// Fills `world`, which was assembled from the same scene. Throws InputError for what is missing or
/// of another size or precision, or does not fit together: what a step relies on without a look.
template <class R>
void read_world(const ArchiveReader& from, World<R>& world);

/// Numbers of archives that not every value is right for. They throw InputError, which names file
/// and member.
double archived_time(const ArchiveReader& from);
Limiter archived_limiter(const ArchiveReader& from, const std::string& name);
std::uint64_t archived_count(const ArchiveReader& from, const std::string& name, double number);

}  // namespace dreampm
