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

/// What long work inside of this scope, on this thread, reports to where its caller cannot pass a
/// Progress: a field that is solved for while a scene file is read.
class ProgressScope {
 public:
  explicit ProgressScope(Progress progress);
  ~ProgressScope();
  ProgressScope(const ProgressScope&) = delete;
  ProgressScope& operator=(const ProgressScope&) = delete;

  /// Of the innermost scope; empty outside of all.
  static const Progress& current();

 private:
  Progress progress_;
  const ProgressScope* outer_;
};

}  // namespace sardf
