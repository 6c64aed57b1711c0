#include "sardf/progress.hpp"

namespace sardf {

namespace {

thread_local const ProgressScope* innermost = nullptr;

}  // namespace

ProgressScope::ProgressScope(Progress progress)
    : progress_(std::move(progress)), outer_(innermost) {
  innermost = this;
}

ProgressScope::~ProgressScope() { innermost = outer_; }

const Progress& ProgressScope::current() {
  static const Progress none;
  return innermost ? innermost->progress_ : none;
}

}  // namespace sardf
