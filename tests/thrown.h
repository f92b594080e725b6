// Returns the error that a call throws, for tests of messages.
#pragma once
#include <gtest/gtest.h>

#include <string>

#include "dreampm/error.h"

namespace dreampm::test {

/// The text of the E that `call` throws; empty, and a failure, if it throws none.
template <class E, class Call>
std::string message_of(const Call& call) {
  try {
    call();
  } catch (const E& e) {
    return e.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

/// The same of an InputError.
template <class Call>
std::string refusal(const Call& call) {
  return message_of<InputError>(call);
}

}  // namespace dreampm::test
