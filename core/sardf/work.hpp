// Loops on all threads, with progress and cancel.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <mutex>

#include "sardf/progress.hpp"

namespace sardf {

class Work {
 public:
  explicit Work(const Progress& progress) : progress_(progress) {}

  /// Loops that follow report shares up to `end`.
  void stage(double end) {
    from_ = to_;
    to_ = end;
  }

  /// The share up to which loops report now.
  double end() const { return to_; }

  /// body(first, last) over [0, n) in parts of `grain`, the same parts for any number of threads.
  template <class Body>
  void run(size_t n, size_t grain, const Body& body) {
    const size_t parts = (n + grain - 1) / grain;
    std::atomic<size_t> done{0};
    std::atomic<bool> cancelled{false};
    tbb::parallel_for(size_t(0), parts, [&](size_t part) {
      if (cancelled) return;
      body(part * grain, std::min(n, (part + 1) * grain));
      ++done;
      if (progress_ && !report(double(done) / double(parts))) cancelled = true;
    });
    // The last part's report may have been left out for another's.
    if (cancelled || (progress_ && !report(1))) throw Cancelled();
  }

 private:
  // One thread reports at a time; the others go on.
  bool report(double share) {
    const std::unique_lock lock(reporting_, std::try_to_lock);
    if (!lock) return true;
    shown_ = std::max(shown_, from_ + (to_ - from_) * share);
    return progress_(shown_);
  }

  const Progress& progress_;
  std::mutex reporting_;
  double from_ = 0, to_ = 0, shown_ = 0;
};

}  // namespace sardf
