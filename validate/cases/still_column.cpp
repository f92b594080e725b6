// A still column: p = rho0 g (H - Y) in the initial height, whatever the equation of state.
#include "validate/measure/column.h"
#include "validate/validation_run.h"

namespace dreampm::validate::cases {
namespace still_column_case {
namespace {

constexpr double g = 9.81, height = 0.4;

/// The reference is always under `g`; a control may run under another.
RowErrors errors(Trial& t, const std::vector<std::string>& overrides, double settle, double watch) {
  ValidationRun<float> run(t, "still-column", overrides);
  const Hydrostatic rest(run.world.sets[0].values, g, height);
  rest.move(run.seeds[0]);
  run.begin();
  rest.press(run.world);
  return column_errors(run.world, rest, height, settle, watch, [&] { run.step(); });
}

Curve curve(std::string name, const RowErrors& rows) {
  Curve c{std::move(name), {}, {}};
  for (std::size_t r = 0; r < rows.error.size(); ++r)
    c.x.push_back(100 * rows.error[r]), c.y.push_back((static_cast<double>(r) + 0.5) * 0.02);
  return c;
}

void run(Trial& t) {
  t.note_choice(
      "Pressed to its hydrostatic state at the start, then watched; each row against the depths of its particles.");
  const RowErrors usual = errors(t, {}, 0.3, 0.6);
  const auto bare_under = [&](const char* gravity) {
    return errors(
        t, {"materials.water.gamma=linear", "materials.water.tension=true", "materials.water.relaxation=0", gravity},
        0.6, 0.2);
  };
  const RowErrors bare = bare_under("gravity=[0,-9.81,0]");
  const RowErrors light = errors(t, {"gravity=[0,-9.2,0]"}, 0.3, 0.3), bare_light = bare_under("gravity=[0,-9.6,0]");
  const auto judge = [&](const std::string& name, const RowErrors& rows, double gate, const char* what,
                         const RowErrors& wrong) {
    const std::string above = name + ": worst row mean above the base row, of rho g H", base = name + ": the base row";
    t.at_most(above, rows.worst_above_the_base(), gate, "%");
    t.at_most(base, std::abs(rows.base()), gate, "%");
    t.control(what, above, wrong.worst_above_the_base());
    t.control(what, base, std::abs(wrong.base()));
  };
  judge("default liquid", usual, 0.04, "gravity 9.2 for 9.81", light);
  judge("bare p = K(1-J)", bare, 0.01, "gravity 9.6 for 9.81", bare_light);
  t.plot({"still-column",
          "Still column: error of the mean pressure of rows of cells",
          "error / (rho g H)  [%]",
          "height  [m]",
          {curve("default liquid", usual), curve("bare p = K(1-J)", bare)}});
}

}  // namespace
}  // namespace still_column_case

extern const Case still_column;
const Case still_column{"still-column",
                        "the pressure of a column at rest, row by row, at the particles' own depths",
                        "hydrostatics, exact: p = rho0 g (H - Y) in the initial height",
                        true,
                        still_column_case::run,
                        3};

}  // namespace dreampm::validate::cases
