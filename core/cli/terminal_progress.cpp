#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <memory>

#include "cli/commands.hpp"

namespace sardf {

namespace {

volatile std::sig_atomic_t interrupted = 0;

void on_interrupt(int) { interrupted = 1; }

// Clears its line when the work ends.
struct Bar {
  std::string label;
  int shown = -1;
  bool visible = isatty(STDERR_FILENO) != 0;
  void draw(double share) {
    const int percent = int(share * 100);
    if (!visible || percent == shown) return;
    shown = percent;
    std::fprintf(stderr, "\r%s %3d %%", label.c_str(), percent);
    std::fflush(stderr);
  }
  ~Bar() {
    if (visible && shown >= 0) std::fprintf(stderr, "\r%*s\r", int(label.size()) + 8, "");
  }
};

}  // namespace

void catch_interrupt() { std::signal(SIGINT, on_interrupt); }

Progress terminal_progress(const std::string& label) {
  auto bar = std::make_shared<Bar>();
  bar->label = label;
  return [bar](double share) {
    bar->draw(share);
    return !interrupted;
  };
}

}  // namespace sardf
