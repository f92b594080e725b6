// The loops over a block's nodes in lanes. Built once per instruction set (DM_ISA), as kernel.cpp.
#include "dreampm/backend/cpu/kernel.h"
#include "dreampm/math/records.h"

static_assert(HWY_STATIC_TARGET == DM_HWY_TARGET,
              "Highway fell to another target than this file's flags are meant for");

namespace dreampm::DM_ISA {
namespace {

using F = Lanes<float>;

struct NodeRow {
  static DM_FN void load(const Node<float>* nodes, Vec3<F>& xyz, F& m) {
    split_in_order(&nodes->x, xyz.x, xyz.y, xyz.z, m);
  }
  static DM_FN void store(const Vec3<F>& xyz, F m, Node<float>* nodes) {
    join_in_order(xyz.x, xyz.y, xyz.z, m, &nodes->x);
  }
  static DM_FN F numbers(const float* p) { return F::load(p); }
  static DM_FN float sum(F a) { return sum_of(a); }
  static DM_FN float largest(F a) { return largest_of(a); }
  static DM_FN unsigned bits(LaneMask m) { return static_cast<unsigned>(bits_of(m)); }
  static DM_FN LaneMask mask(unsigned bits) { return mask_of(bits); }
};

void momentum_to_velocity(Node<float>* nodes, float keep, const Vec3<float>& kick, NodeSums& sums) {
  convert_nodes<F, NodeRow>(nodes, keep, kick, sums);
}
void measure(const Node<float>* nodes, NodeSums& sums) { measure_nodes<F, NodeRow>(nodes, sums); }
void box_contact(Node<float>* nodes, const BoxWalls<float>& walls, int side, const float* approach,
                 ImpulseSum& impulses) {
  contact_nodes<F, NodeRow>(nodes, walls, side, approach, impulses);
}
std::uint16_t fold_ghosts(const MirrorPlanes<float>& planes, ImpulseSum& impulses) {
  return fold_planes<F, NodeRow>(planes, impulses);
}
double reflect_ghosts(const MirrorPlanes<float>& planes, std::uint16_t folded, ImpulseSum& impulses) {
  return reflect_planes<F, NodeRow>(planes, folded, impulses);
}

}  // namespace

NodeLoops<float> node_loops() { return {&momentum_to_velocity, &measure, &box_contact, &fold_ghosts, &reflect_ghosts}; }

}  // namespace dreampm::DM_ISA
