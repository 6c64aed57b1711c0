// The subcommands of `sardf`: one file each, command_*.cpp. Each adds its options to the app and
// runs when it is chosen; it throws Error for wrong input and CLI::RuntimeError(1) for work that
// failed.
#pragma once

#include <string>

#include "sardf/progress.hpp"

namespace CLI {
class App;
}

namespace sardf {

void add_check(CLI::App& app);
void add_eval(CLI::App& app);
void add_mesh(CLI::App& app);
void add_bake(CLI::App& app);
void add_povray(CLI::App& app);
void add_stage(CLI::App& app);
void add_render(CLI::App& app);
void add_compare(CLI::App& app);
void add_solve(CLI::App& app);
void add_schema(CLI::App& app);
void add_image(CLI::App& app);

/// A bar on standard error where that is a terminal, nothing elsewhere; Ctrl-C cancels.
Progress terminal_progress(const std::string& label);

/// Ctrl-C cancels running work instead of ending the process at once.
void catch_interrupt();

}  // namespace sardf
