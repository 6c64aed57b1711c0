// Include files, their density files and scenes that appear all at once.
#pragma once

#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "povray_gen/scene_text.hpp"
#include "sardf/output_file.hpp"
#include "sardf/scene.hpp"

namespace sardf::povray {

/// What a scene draws, its fields and its colours; camera, size and look keep their defaults.
/// `title` where the scene has none.
PovrayScene povray_scene_of(const Scene& scene, const std::string& title);

/// Files under temporary names until commit(). What was begun and not committed leaves nothing.
class PendingFiles {
 public:
  /// Begins the include file and the density files that it reads, beside it. Returns all texts.
  /// Throws as scene_text does; Failure when a file cannot be written.
  SceneText add(const PovrayScene& scene, const std::filesystem::path& include,
                const SamplingOptions& sampling);
  /// Begins any file.
  void add(const std::filesystem::path& path, const std::string& text);
  /// Gives all files their names, and removes the density files that replaced include files read
  /// and the new ones do not.
  void commit();

 private:
  OutputFile& begin(const std::filesystem::path& path);

  std::vector<std::unique_ptr<OutputFile>> files_;
  std::vector<std::string> earlier_;
  std::set<std::string> now_;
};

}  // namespace sardf::povray
