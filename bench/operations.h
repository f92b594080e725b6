// How much work a particle-step is, whatever the machine: the two floors that its time stands on.
#pragma once
#include <string_view>

#include "bench/counted.h"
#include "dreampm/state/world.h"

namespace dreampm {

/// Operations of one particle of the world's first set in one step: stencils, gather, law, move,
/// energies for the ledger, scatter. Counted by running those very templates once, in a step that
/// shifts no liquids, as seven of eight; splines belong to nodes and are not counted. The visit of
/// the nodes, an eighth of a node a particle in the bulk, is not in it.
OperationCount operations_of(const World<float>& world);

/// True if a multiply-add is one instruction in that set.
inline bool fuses(std::string_view isa) { return isa != "sse4"; }

/// Bytes that a step has to move a particle if every column and node is read once and written once;
/// write-allocation is not counted, as it is not in the triad that this is compared with.
double bytes_moved_of(const World<float>& world);

}  // namespace dreampm
