#include "source_folder.hpp"

namespace sardf {

const std::filesystem::path& source_folder() {
  static const std::filesystem::path folder = SARDF_SOURCE_DIR;
  return folder;
}

}  // namespace sardf
