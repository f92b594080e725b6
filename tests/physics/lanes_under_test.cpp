#include "lanes_under_test.h"

#include "dreampm/math/explog.h"
#include "dreampm/math/lanes.h"
#include "dreampm/math/svd3.h"
#include "dreampm/physics/materials.h"

namespace dreampm::DM_ISA {
namespace {

using F = Lanes<float>;
constexpr int W = F::count;
static_assert(lanes_tested % W == 0);

template <class M>
void advance_material(LawCall& c) {
  const auto& law = *static_cast<const typename M::template Law<float>*>(c.law);
  for (int p = 0; p < lanes_tested; p += W) {
    typename M::template State<F> state;
    for (int k = 0; k < state_columns<M>; ++k) state[k] = F::load(&c.state[k][p]);
    StrainIncrement<F> at{{},
                          F(c.dt),
                          F::load(&c.volume[p]),
                          c.volume_relaxation,
                          F(c.strain),
                          F::load(&c.inside[p]),
                          F::load(&c.surface_filled[p]),
                          F::load(&c.at_rest[p])};
    for (int k = 0; k < 9; ++k) at.gradient.m[k] = F::load(&c.gradient[k][p]);
    const StressResponse<F> r = advanced(law, state, at);
    for (int k = 0; k < state_columns<M>; ++k) state[k].store(&c.state[k][p]);
    r.tau.xx.store(&c.tau[0][p]), r.tau.yy.store(&c.tau[1][p]), r.tau.zz.store(&c.tau[2][p]);
    r.tau.xy.store(&c.tau[3][p]), r.tau.xz.store(&c.tau[4][p]), r.tau.yz.store(&c.tau[5][p]);
    r.energy.store(&c.energy[p]), r.sound_speed.store(&c.sound[p]);
    r.kinematic_viscosity.store(&c.viscosity[p]), r.implicit_viscosity.store(&c.implicit[p]);
  }
}

template <class... M>
void advance_one_of(int material, LawCall& c, MaterialList<M...>) {
  int i = 0;
  ((i++ == material ? advance_material<M>(c) : void()), ...);
}

void advance(int material, LawCall& c) { advance_one_of(material, c, Materials{}); }

void svd(SvdCall& c) {
  for (int p = 0; p < lanes_tested; p += W) {
    Mat3<F> f;
    for (int k = 0; k < 9; ++k) f.m[k] = F::load(&c.f[k][p]);
    const Svd3<F> d = svd3(f);
    for (int k = 0; k < 9; ++k) d.u.m[k].store(&c.u[k][p]), d.v.m[k].store(&c.v[k][p]);
    for (int k = 0; k < 3; ++k) d.s[k].store(&c.s[k][p]);
  }
}

void exp_log(ExpLogCall& c) {
  for (int p = 0; p < lanes_tested; p += W) {
    exp(F::load(&c.a[p])).store(&c.exp_a[p]);
    log(F::load(&c.b[p])).store(&c.log_b[p]);
  }
}

}  // namespace

LanesUnderTest lanes_under_test() { return {W, &advance, &svd, &exp_log}; }

}  // namespace dreampm::DM_ISA
