#include "dreampm/play/model/ages.h"

#include <string>

namespace dreampm::play {

void Ages::see(std::span<const std::uint32_t> ids, double time) {
  for (const std::uint32_t id : ids) {
    if (id >= born_.size()) born_.resize(id + std::size_t{1}, unseen);
    if (born_[id] == unseen) born_[id] = time;
  }
}

void Ages::back_to(double time) {
  for (double& born : born_)
    if (born > time) born = unseen;
}

float Ages::age(std::uint32_t id, double time) const {
  return id < born_.size() && born_[id] != unseen ? static_cast<float>(time - born_[id]) : 0;
}

void Arrivals::see(const Simulation& simulation) {
  const double now = simulation.time();
  const std::uint32_t next = simulation.next_id();
  if (seen_until == next) return;
  for (const std::string& material : simulation.scene().materials())
    simulation.visit(material, {.position = false, .id = true},
                     [&](const ParticleBatch& some) { ages.see(some.id, now); });
  seen_until = next;
}

}  // namespace dreampm::play
