#include "dreampm/play/model/ages.h"

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

}  // namespace dreampm::play
