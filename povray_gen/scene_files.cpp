#include "povray_gen/scene_files.hpp"

#include <cmath>
#include <filesystem>

#include "povray_gen/pending_files.hpp"
#include "povray_gen/run.hpp"
#include "povray_gen/scene_text.hpp"
#include "sardf/error.hpp"

namespace sardf::povray {

namespace {

namespace fs = std::filesystem;

Look look_of(const std::string& name) {
  if (name == "shaded") return Look::shaded;
  if (name == "flat") return Look::flat;
  if (name == "normals") return Look::normals;
  throw Error("there is no look '" + name + "'; accepted are shaded, flat, normals" +
              did_you_mean(name, {"shaded", "flat", "normals"}));
}

}  // namespace

std::vector<std::string> write_files(const Scene& scene, const SceneFiles& files,
                                     const Progress& progress) {
  if (!files.path.ends_with(".pov")) {
    throw Error("the output must end in .pov; the functions go into an .inc file beside it",
                files.path);
  }
  if (files.samples < 8 || files.samples > 512) {
    throw Error("samples is " + std::to_string(files.samples) + "; 8 to 512 is accepted");
  }
  const fs::path include = fs::path(files.path).replace_extension(".inc");
  PovrayScene text = povray_scene_of(scene, include.stem());
  text.camera = files.camera;
  text.width = files.width;
  text.height = files.height;
  text.look = look_of(files.look);
  SamplingOptions sampling;
  sampling.progress = progress;
  sampling.most_samples = std::pow(files.samples, 3);
  sampling.all_fields = files.all_fields;
  PendingFiles pending;
  const SceneText made = pending.add(text, include, sampling);
  pending.add(files.path, made.scene);
  pending.commit();
  return made.sentences;
}

void render_files(const SceneFiles& files, const std::string& image, const Progress& progress,
                  const std::function<std::string(const std::string&)>& check) {
  const std::string ending = fs::path(image).extension();
  if (ending != ".exr" && ending != ".png") {
    throw Error("the picture ends in '" + ending + "'; .exr and .png are accepted", image);
  }
  RunOptions options;
  options.width = files.width;
  options.height = files.height;
  options.format = ending == ".exr" ? Format::exr : Format::png8;
  // A lit picture has a background; the others are cut out by their alpha.
  const bool shaded = look_of(files.look) == Look::shaded;
  options.alpha = !shaded;
  options.antialias = shaded;
  options.progress = progress;
  render(files.path, image, options, check);
}

}  // namespace sardf::povray
