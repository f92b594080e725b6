#include "dreampm/solver/solver.h"

#include "dreampm/solver/form_grid.h"
#include "dreampm/solver/projection/projection.h"
#include "dreampm/solver/step.h"

namespace dreampm {
namespace {

/// The steps of solver/step.h.
template <class R>
class ExplicitSolver final : public Solver<R> {
 public:
  explicit ExplicitSolver(Backend<R>& backend) : backend_(backend) {}
  void attach(const World<R>& world, const Motion<R>*) override { backend_.attach(world); }
  void begin(World<R>& world, const std::vector<std::vector<ParticleSeed>>& seeds) override {
    dreampm::begin(world, backend_, seeds);
  }
  PassStats insert(World<R>& world, std::size_t set, std::span<const ParticleSeed> seeds) override {
    return backend_.insert_particles(world, set, seeds);
  }
  StepSums step(World<R>& world, Motion<R>& motion, double next_sample_time, BodyContacts* contacts) override {
    return dreampm::step(world, backend_, &motion, next_sample_time, contacts);
  }
  void form_grid(World<R>& world, Motion<R>& motion) override { dreampm::form_grid(world, backend_, motion, spare_); }

 private:
  Backend<R>& backend_;
  Motion<R> spare_;  ///< of form_grid
};

}  // namespace

template <class R>
std::unique_ptr<Solver<R>> make_solver(const World<R>& world, Backend<R>& backend) {
  if (world.settings.solver == SolverKind::projection) return std::make_unique<Projection<R>>(&backend);
  return std::make_unique<ExplicitSolver<R>>(backend);
}

template std::unique_ptr<Solver<float>> make_solver(const World<float>&, Backend<float>&);
template std::unique_ptr<Solver<double>> make_solver(const World<double>&, Backend<double>&);

}  // namespace dreampm
