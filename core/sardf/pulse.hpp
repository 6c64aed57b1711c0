// Progress of work that is no plain loop over equal parts: recursion, serial passes, readers. Loops
// on all threads have Work (work.hpp).
#pragma once

#include <atomic>
#include <mutex>

#include "sardf/progress.hpp"

namespace sardf {

class Pulse {
 public:
  /// Keeps a reference. Without a callback everything here does nothing.
  explicit Pulse(const Progress& progress) : progress_(progress) {}
  /// For work that nobody waits for.
  static Pulse& none();

  /// Shares given from now on are of what lies between the last stage's end and this one.
  void stage(double end);
  /// What is done of the stage, in [0, 1], from any thread and as often as wanted: the callback is
  /// asked every few milliseconds, by one thread at a time. Throws Cancelled, on every thread, once
  /// it said so.
  void operator()(double share);
  /// The same for step i of n of a loop, which costs next to nothing.
  void step(size_t i, size_t n) {
    if (i % every == 0) (*this)(double(i) / double(n));
  }

 private:
  // So many steps of the fastest loops take some microseconds.
  static constexpr size_t every = 1024;

  const Progress& progress_;
  std::mutex reporting_;
  std::atomic<bool> cancelled_{false};
  std::atomic<long long> next_{0};  // time of the next report, in nanoseconds
  double from_ = 0, to_ = 0, shown_ = 0;
};

/// A callback for a part of some work, whose shares run between two of the whole's; keeps a
/// reference. Empty where the whole is.
Progress part_of(const Progress& whole, double from, double to);

}  // namespace sardf
