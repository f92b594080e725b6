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

/// True if any transfer has this key.
inline bool is_transfer_key(std::string_view key) {
  bool found = false;
  Transfers::for_each([&]<class T>() {
    for (const MemberParam<T>& p : T::params) found = found || p.key == key;
  });
  return found;
}

/// The transfer of that name, `apic` for one that is not in the list, with these of its numbers.
inline AnyTransfer make_transfer(std::string_view name, const Values& values) {
  AnyTransfer transfer = Apic{};
  Transfers::for_each([&]<class T>() {
    if (T::name == name) transfer = with_members<T>(values);
  });
  return transfer;
}

}  // namespace dreampm
