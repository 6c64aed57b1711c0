#include <CLI/CLI.hpp>
#include <iostream>

#include "cli/commands.hpp"
#include "sardf/scene_file.hpp"

namespace sardf {

void add_schema(CLI::App& app) {
  CLI::App* command = app.add_subcommand("schema", "Print the JSON Schema of scene files");
  command->callback([] { std::cout << scene_schema(); });
}

}  // namespace sardf
