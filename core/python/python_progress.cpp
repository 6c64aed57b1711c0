#include "python_progress.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace sardf {

namespace {

constexpr std::chrono::milliseconds between_looks(10);
// How many fields will be solved for while a scene is read is not known before.
constexpr double share_of_next = 0.9;

/// For parts of unknown number that report from 0 to 1, one after the other: each has 9/10 of what
/// is left.
Progress one_after_the_other(const Progress& progress) {
  return [&progress, from = 0.0, last = 0.0](double share) mutable {
    if (share < last) from += share_of_next * (1 - from);
    last = share;
    return progress(from + share_of_next * (1 - from) * share);
  };
}

/// A thread that is joined in any case, and what it threw.
class Beside {
 public:
  explicit Beside(const std::function<void()>& work)
      : thread_([this, &work] {
          try {
            work();
          } catch (...) {
            thrown_ = std::current_exception();
          }
          const std::scoped_lock lock(mutex_);
          done_ = true;
          changed_.notify_one();
        }) {}
  ~Beside() { thread_.join(); }

  /// Whether the work has ended after a while.
  bool is_done() {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, between_looks, [this] { return done_; });
  }
  /// After it has ended.
  const std::exception_ptr& thrown() const { return thrown_; }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool done_ = false;
  std::exception_ptr thrown_;
  std::thread thread_;  // the last member: it uses the others
};

}  // namespace

bool PythonProgress::call(double share) {
  if (interrupted_) return false;
  if (callable_.is_none()) return true;
  py::gil_scoped_acquire acquire;
  if (raised_) return false;
  try {
    const py::object answer = callable_(share);
    return answer.is_none() || py::cast<bool>(answer);
  } catch (...) {
    raised_ = std::current_exception();
    return false;
  }
}

void PythonProgress::wait_for_signals(const std::function<bool()>& is_done) {
  while (!is_done()) {
    if (interrupted_) continue;
    py::gil_scoped_acquire acquire;
    // Runs handlers on Python's main thread; on others it does nothing.
    if (PyErr_CheckSignals() == 0) continue;
    raised_ = std::make_exception_ptr(py::error_already_set());
    interrupted_ = true;
  }
}

void PythonProgress::run_beside(const std::function<void(const Progress&)>& work) {
  const Progress progress = [this](double share) { return call(share); };
  const std::function<void()> with_scope = [&] {
    const ProgressScope scope(one_after_the_other(progress));
    work(progress);
  };
  std::exception_ptr thrown;
  {
    py::gil_scoped_release release;
    Beside beside(with_scope);
    wait_for_signals([&] { return beside.is_done(); });
    thrown = beside.thrown();
  }
  if (raised_) std::rethrow_exception(raised_);
  if (thrown) std::rethrow_exception(thrown);
}

}  // namespace sardf
