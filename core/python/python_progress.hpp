// Long work called from Python: reports, cancel and Ctrl-C.
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <exception>
#include <functional>
#include <optional>

#include "sardf/progress.hpp"

namespace sardf {

namespace py = pybind11;

/// A Python callable as a progress; None reports to nobody. It is called with the share done, and
/// cancels by returning False. An exception in it, or one of Python's signal handlers (Ctrl-C
/// raises KeyboardInterrupt), cancels the work and is raised in Cancelled's place.
class PythonProgress {
 public:
  explicit PythonProgress(py::object callable) : callable_(std::move(callable)) {}

  /// What work(progress) returns. It runs without the GIL on a thread of its own, so that this one
  /// hears signals whichever thread is busy. Fields that it makes report to the progress, too.
  template <class Work>
  auto run(const Work& work) {
    std::optional<decltype(work(Progress()))> made;
    run_beside([&](const Progress& progress) { made.emplace(work(progress)); });
    return std::move(*made);
  }

 private:
  void run_beside(const std::function<void(const Progress&)>& work);
  bool call(double share);
  void wait_for_signals(const std::function<bool()>& is_done);

  py::object callable_;
  std::exception_ptr raised_;  // read and written with the GIL
  std::atomic<bool> interrupted_ = false;
};

}  // namespace sardf
