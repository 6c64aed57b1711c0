// Progress and cancel between the blocks of a picture; private to core/sardf/render*.cpp.
#pragma once

#include <atomic>

#include "sardf/pulse.hpp"

namespace sardf::rendering {

/// What all threads ask whether to go on: it throws Cancelled. A tile of a slow field may take
/// long, so that they ask between blocks of points and not only between tiles.
class Watch {
 public:
  Watch(const Progress& progress, size_t tiles)
      : progress_(progress), pulse_(progress), tiles_(double(tiles)) {}

  void check() { pulse_(double(done_) / tiles_); }
  void tile_done() { ++done_; }
  /// At the end, when all threads are done.
  void finish() {
    if (progress_ && !progress_(1)) throw Cancelled();
  }

 private:
  const Progress& progress_;
  Pulse pulse_;
  const double tiles_;
  std::atomic<size_t> done_{0};
};

}  // namespace sardf::rendering
