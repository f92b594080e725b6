#include "dreampm/state/force_fields.h"

#include <algorithm>

#include "dreampm/base/parallel.h"

namespace dreampm {

template <class R>
FieldSteps<R>::FieldSteps(const World<R>& world, double dt) {
  // A node a rounding error outside a face of the box lies in it.
  const double slack = 1e-6 * world.dx;
  for (const ForceField& f : world.fields) {
    Box3d box{{-1e30, -1e30, -1e30}, {1e30, 1e30, 1e30}};
    if (f.box) box = {f.box->min - Vec3d{slack, slack, slack}, f.box->max + Vec3d{slack, slack, slack}};
    std::visit(
        [&](const auto& field) {
          if constexpr (requires { field.bounds(); })
            box = {max(box.min, field.bounds().min), min(box.max, field.bounds().max)};
        },
        f.field);
    fields_.push_back({Fields::step<R>(f.field, dt), box});
  }
}

template <class R>
bool FieldSteps<R>::any_in(const World<R>& world, const Vec3i& block) const {
  const Vec3d first = world.node_position(block * block_width);
  const double width = (block_width - 1) * world.dx;
  return std::any_of(fields_.begin(), fields_.end(), [&](const One& f) {
    for (int a = 0; a < 3; ++a)
      if (first[a] > f.box.max[a] || first[a] + width < f.box.min[a]) return false;
    return true;
  });
}

template <class R>
Vec3<R> FieldSteps<R>::apply(Vec3<R> v, const Vec3d& x) const {
  for (const One& f : fields_)
    if (f.box.contains(x)) v = std::visit([&](const auto& step) { return step(v, static_cast<Vec3<R>>(x)); }, f.step);
  return v;
}

template <class R>
R FieldSteps<R>::fastest(R speed, const Vec3d& x) const {
  for (const One& f : fields_)
    if (f.box.contains(x))
      speed = std::visit([&](const auto& step) { return step.fastest(speed, static_cast<Vec3<R>>(x)); }, f.step);
  return speed;
}

template <class R>
double fastest_after_fields(const World<R>& world, double speed, double dt) {
  const FieldSteps<R> fields(world, dt);
  if (!fields.any()) return speed;
  const auto look = [&](R& most, std::size_t b) {
    if (!fields.any_in(world, world.grid.blocks[b])) return;
    const Vec3i first = world.grid.blocks[b] * block_width;
    for (int n = 0; n < block_nodes; ++n)
      most = std::max(most, fields.fastest(static_cast<R>(speed), world.node_position(first + node_offset(n))));
  };
  const R most = parallel_reduce(world.grid.blocks.size(), static_cast<R>(speed), look,
                                 [](R& all, const R& some) { all = std::max(all, some); });
  return std::max(speed, static_cast<double>(most));
}

template class FieldSteps<float>;
template class FieldSteps<double>;
template double fastest_after_fields(const World<float>&, double, double);
template double fastest_after_fields(const World<double>&, double, double);

}  // namespace dreampm
