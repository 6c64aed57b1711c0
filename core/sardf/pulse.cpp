#include "sardf/pulse.hpp"

#include <algorithm>
#include <chrono>
#include <ctime>

namespace sardf {

namespace {

// A cancel has to take effect within 100 ms.
constexpr long long interval = 10'000'000;

// Asked for every few microseconds: to some milliseconds, in a fifth of the time, where there is
// such a clock.
long long now() {
#ifdef CLOCK_MONOTONIC_COARSE
  timespec time{};
  if (clock_gettime(CLOCK_MONOTONIC_COARSE, &time) == 0)
    return time.tv_sec * 1'000'000'000LL + time.tv_nsec;
#endif
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

}  // namespace

Pulse& Pulse::none() {
  static const Progress nobody;
  static Pulse silent(nobody);
  return silent;
}

void Pulse::stage(double end) {
  if (!progress_) return;
  from_ = to_;
  to_ = end;
}

void Pulse::operator()(double share) {
  if (!progress_) return;
  if (cancelled_) throw Cancelled();
  if (now() < next_) return;
  const std::unique_lock lock(reporting_, std::try_to_lock);
  if (!lock) return;
  shown_ = std::max(shown_, from_ + (to_ - from_) * std::clamp(share, 0.0, 1.0));
  if (!progress_(shown_)) cancelled_ = true;
  next_ = now() + interval;
  if (cancelled_) throw Cancelled();
}

Progress part_of(const Progress& whole, double from, double to) {
  if (!whole) return {};
  return [&whole, from, to](double share) { return whole(from + (to - from) * share); };
}

}  // namespace sardf
