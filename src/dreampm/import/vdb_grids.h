// OpenVDB, and its grids of floats compiled once. For files that would include OpenVDB themselves.
#pragma once
#include <openvdb/openvdb.h>

// Else each file that makes a grid compiles all of its virtual functions, half a minute of work:
// OpenVDB declares so its tools, not its grids.
extern template class openvdb::tree::Tree<openvdb::FloatTree::RootNodeType>;
extern template class openvdb::Grid<openvdb::FloatTree>;
