// A scene rendered by a Blender in another process, for comparisons.
#pragma once

#include <string>
#include <vector>

#include "sardf/progress.hpp"

namespace sardf {

/// A Blender program, or a Python that has the bpy module.
struct Blender {
  std::string label;                 // "Blender 3.4.1"
  std::vector<std::string> command;  // up to the arguments of headless.py
};

struct BlenderJob {
  std::string scene;   // path
  std::string folder;  // where pictures go
  std::string camera;  // path of a camera.json
  std::string looks = "flat,normals";
  int width = 640, height = 480, resolution = 128, texture_size = 2048, samples = 64;
};

/// The add-on's headless.py: below the working folder, or beside a folder that holds this program.
std::string find_headless();

/// The Blender that `program` is: its version is asked. Throws Error when it cannot be run or
/// has no bpy, or when `headless` (the add-on's headless.py) is missing.
Blender find_blender(const std::string& program, const std::string& headless);

/// Runs the job; the pictures are job.folder/flat.exr, normals.exr and part.png. Throws
/// std::runtime_error with Blender's own words when it fails, Cancelled.
void render_in_blender(const Blender& blender, const BlenderJob& job, const Progress& progress);

}  // namespace sardf
