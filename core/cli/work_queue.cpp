#include "cli/work_queue.hpp"

#include <exception>
#include <mutex>
#include <thread>

namespace sardf {

void run_jobs(const std::vector<std::function<void()>>& jobs, int at_a_time) {
  std::mutex guard;
  size_t next = 0;
  std::exception_ptr failure;
  const auto work = [&] {
    for (;;) {
      size_t mine;
      {
        const std::scoped_lock lock(guard);
        if (failure || next == jobs.size()) return;
        mine = next++;
      }
      try {
        jobs[mine]();
      } catch (...) {
        const std::scoped_lock lock(guard);
        if (!failure) failure = std::current_exception();
      }
    }
  };
  std::vector<std::jthread> threads;
  for (int i = 0; i < at_a_time; ++i) threads.emplace_back(work);
  threads.clear();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace sardf
