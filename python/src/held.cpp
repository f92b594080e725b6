#include "held.h"

namespace dreampm::python {

void HeldSimulation::on_step(nb::callable observer) {
  const Use use(*this);
  const std::size_t i = step_observers_.size();
  step_observers_.push_back(std::move(observer));
  simulation_.on_step([this, i](const StepReport& report) {
    const nb::gil_scoped_acquire held;
    if (i >= step_observers_.size()) return;  // the garbage collector took them
    const nb::object kept = step_observers_[i];
    kept(report);
  });
}

void HeldSimulation::on_frame(nb::callable observer) {
  const Use use(*this);
  const std::size_t i = frame_observers_.size();
  frame_observers_.push_back(std::move(observer));
  simulation_.on_frame([this, i](const FrameEvent& event) {
    const nb::gil_scoped_acquire held;
    if (i >= frame_observers_.size()) return;  // the garbage collector took them
    const nb::object kept = frame_observers_[i];
    kept(event);
  });
}

int HeldSimulation::traverse(visitproc visit, void* arg) const {
  for (const nb::object& o : step_observers_) Py_VISIT(o.ptr());
  for (const nb::object& o : frame_observers_) Py_VISIT(o.ptr());
  return 0;
}

void HeldSimulation::clear() {
  step_observers_.clear();
  frame_observers_.clear();
}

namespace {

template <class T>
int traverse(PyObject* self, visitproc visit, void* arg) {
  Py_VISIT(Py_TYPE(self));
  if (!nb::inst_ready(self)) return 0;
  if constexpr (std::is_same_v<T, HeldSimulation>)
    return nb::inst_ptr<T>(self)->traverse(visit, arg);
  else
    Py_VISIT(nb::inst_ptr<T>(self)->simulation.ptr());
  return 0;
}

int clear_simulation(PyObject* self) {
  nb::inst_ptr<HeldSimulation>(self)->clear();
  return 0;
}

int clear_part(PyObject* self) {
  nb::inst_ptr<PartOf>(self)->simulation.reset();
  return 0;
}

}  // namespace

const PyType_Slot simulation_slots[] = {{Py_tp_traverse, reinterpret_cast<void*>(traverse<HeldSimulation>)},
                                        {Py_tp_clear, reinterpret_cast<void*>(clear_simulation)},
                                        {0, nullptr}};
const PyType_Slot part_slots[] = {{Py_tp_traverse, reinterpret_cast<void*>(traverse<PartOf>)},
                                  {Py_tp_clear, reinterpret_cast<void*>(clear_part)},
                                  {0, nullptr}};

}  // namespace dreampm::python
