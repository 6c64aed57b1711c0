#include "cli/render_povray.hpp"

#include <algorithm>
#include <filesystem>

#include "cli/compare_images.hpp"
#include "cli/write_text.hpp"
#include "povray_gen/run.hpp"
#include "povray_gen/scene_text.hpp"
#include "sardf/error.hpp"

namespace sardf {

namespace {

namespace fs = std::filesystem;

povray::Look look_of(const std::string& name) {
  if (name == "flat") return povray::Look::flat;
  if (name == "normals") return povray::Look::normals;
  return povray::Look::shaded;
}

// POV-Ray calls a picture of nothing a success.
std::string empty_picture(const std::string& path) {
  const Image image = read_image(path, Meaning::color);
  const Mask mask = mask_from_alpha(image);
  const bool any = std::any_of(mask.begin(), mask.end(), [](unsigned char m) { return m != 0; });
  return any ? "" : "the picture shows nothing of the object";
}

}  // namespace

void write_povray(const Scene& scene, const PovrayJob& job) {
  const SceneDescription& d = scene.description();
  povray::PovrayScene text;
  const std::string stem = fs::path(job.path).stem();
  text.title = d.title.empty() ? stem : d.title;
  text.solid = scene.drawn();
  text.bounds = scene.bounds();
  for (const NamedField& named : d.fields) {
    text.fields.push_back({named.name, named.field.expression()});
  }
  text.color = scene.base_color();
  text.camera = job.camera;
  text.width = job.width;
  text.height = job.height;
  text.look = look_of(job.look);
  text.stated_lipschitz = d.stated_lipschitz;
  const fs::path include = fs::path(job.path).replace_extension(".inc");
  const povray::SceneText made = povray::scene_text(text, include.filename());
  write_text(include, made.include);
  write_text(job.path, made.scene);
}

void render_povray(const PovrayJob& job, const std::string& image, const Progress& progress) {
  const fs::path path(image);
  const bool exr = path.extension() == ".exr";
  if (!exr && path.extension() != ".png") {
    throw Error(
        "the picture ends in '" + path.extension().string() + "'; .exr and .png are accepted",
        image);
  }
  povray::RunOptions options;
  options.width = job.width;
  options.height = job.height;
  options.format = exr ? povray::Format::exr : povray::Format::png8;
  // A lit picture has a background; the others are cut out by their alpha.
  const bool shaded = job.look == "shaded";
  options.alpha = !shaded;
  options.antialias = shaded;
  options.progress = progress;
  povray::render(job.path, image, options,
                 shaded ? std::function<std::string(const std::string&)>() : empty_picture);
}

}  // namespace sardf
