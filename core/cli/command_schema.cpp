#include <CLI/CLI.hpp>
#include <iostream>

#include "cli/commands.hpp"
#include "sardf/document.hpp"
#include "sardf/scene_file.hpp"

namespace sardf {

void add_schema(CLI::App& app) {
  CLI::App* command = app.add_subcommand("schema", "Print the JSON Schema of scene files");
  const auto document = std::make_shared<bool>(false);
  command->add_flag("--document", *document, "Print docs/operations.md instead");
  command->callback(
      [document] { std::cout << (*document ? operations_document() : scene_schema()); });
}

}  // namespace sardf
