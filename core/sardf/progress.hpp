// Progress and cancel for long work.
#pragma once

#include <functional>
#include <stdexcept>

namespace sardf {

/// Called with the share done in [0, 1], from one thread at a time; return false to cancel. The
/// work then stops within 0.1 s and throws Cancelled. Empty: no reports, no cancel.
using Progress = std::function<bool(double)>;

struct Cancelled : std::runtime_error {
  Cancelled() : std::runtime_error("cancelled") {}
};

}  // namespace sardf
