// Progress and cancel between the blocks of a picture; private to core/sardf/render*.cpp.
#pragma once

#include <atomic>
#include <chrono>
#include <mutex>

#include "sardf/progress.hpp"

namespace sardf::rendering {

/// What all threads ask whether to go on. A tile of a slow field may take long, so that they ask
/// between blocks of points and not only between tiles.
class Watch {
 public:
  Watch(const Progress& progress, size_t tiles) : progress_(progress), tiles_(double(tiles)) {}

  /// Reports now and then, from one thread at a time.
  bool go_on() {
    if (!progress_ || stopped_) return !stopped_;
    const std::unique_lock lock(reporting_, std::try_to_lock);
    const auto now = std::chrono::steady_clock::now();
    if (!lock || now - reported_ < std::chrono::milliseconds(20)) return true;
    reported_ = now;
    if (!progress_(double(done_) / tiles_)) stopped_ = true;
    return !stopped_;
  }
  void check() {
    if (!go_on()) throw Cancelled();
  }
  void tile_done() { ++done_; }
  /// At the end, when all threads are done.
  void finish() {
    if (stopped_ || (progress_ && !progress_(1))) throw Cancelled();
  }

 private:
  const Progress& progress_;
  const double tiles_;
  std::atomic<size_t> done_{0};
  std::atomic<bool> stopped_{false};
  std::mutex reporting_;
  std::chrono::steady_clock::time_point reported_{};
};

}  // namespace sardf::rendering
