// What an action's Error says.
#pragma once

#include <functional>
#include <string>

#include "sardf/error.hpp"

namespace sardf {

/// "no error" when there was none.
inline std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace sardf
