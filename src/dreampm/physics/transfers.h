// The one list of transfers. A new one: its file in transfers/, and its name here.
#pragma once
#include <variant>

#include "dreampm/physics/transfers/apic.h"
#include "dreampm/physics/transfers/asflip.h"
#include "dreampm/physics/transfers/flip.h"

namespace dreampm {

template <class... T>
struct TransferList {
  using Any = std::variant<T...>;
  /// Calls f.template operator()<T>() for each type in order.
  template <class Call>
  static void for_each(Call&& f) {
    (f.template operator()<T>(), ...);
  }
};

using Transfers = TransferList<Apic, Flip, Asflip>;
using AnyTransfer = Transfers::Any;

}  // namespace dreampm
