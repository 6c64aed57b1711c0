// Other programs, run as child processes.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sardf/progress.hpp"

namespace sardf {

struct ProcessOptions {
  std::string folder = {};  ///< where it runs; empty: the current folder
  double timeout = 0;       ///< seconds after which it is killed; 0: none
  Progress progress = {};   ///< asked every 0.05 s whether to go on, with `share`'s answer, or 0
  /// How far it is, in [0, 1], by all that it has written to standard error.
  std::function<double(const std::string&)> share = {};
};

struct ProcessResult {
  int exit_code = 0;  ///< 128 + signal where a signal ended it, as shells count
  bool timed_out = false;
  std::string output;  ///< what it wrote to standard output
  std::string errors;  ///< what it wrote to standard error
};

/// Runs arguments[0] (a path, or a name that PATH finds) with the other arguments, standard input
/// empty, and waits for its end. Throws Error if it cannot be started and Cancelled, after killing
/// it, if the progress says so. It dies with us: no child outlives a killed parent.
ProcessResult run_process(const std::vector<std::string>& arguments,
                          const ProcessOptions& options = {});

/// The path of a program: the value of the environment variable where it is set, else the first
/// folder of PATH that holds it. Empty if there is none.
std::string find_program(const std::string& name, const std::string& variable = "");

}  // namespace sardf
