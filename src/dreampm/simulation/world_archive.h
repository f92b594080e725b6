// The state of a world in an archive, and back: the same bits. What a scene gives is not in it.
#pragma once
#include "dreampm/io/archive.h"
#include "dreampm/state/world.h"

namespace dreampm {

template <class R>
void write_world(ArchiveWriter& to, const World<R>& world);

/// Fills `world`, which was assembled from the same scene. Throws InputError for what is missing or
/// of another size or precision.
template <class R>
void read_world(const ArchiveReader& from, World<R>& world);

}  // namespace dreampm
