// The scene that a command works on, with the switch that joins its booleans by another blend.
#pragma once

#include <string>

#include "sardf/scene.hpp"

namespace CLI {
class App;
}

namespace sardf {

struct SceneOption {
  std::string path, blend;

  /// Adds the argument `scene` and the option --blend.
  void add_to(CLI::App& command);
  /// Reads the scene and finds its bounds. Throws Error for a wrong file or blend.
  Scene read(const Progress& progress = {}) const;
};

}  // namespace sardf
