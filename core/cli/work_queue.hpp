// Independent jobs run a few at a time.
#pragma once

#include <functional>
#include <vector>

namespace sardf {

/// Runs every job, `at_a_time` of them at once, in order of the list. When one throws, the jobs not
/// yet started are dropped and the first exception is thrown again after the running ones ended.
void run_jobs(const std::vector<std::function<void()>>& jobs, int at_a_time);

}  // namespace sardf
