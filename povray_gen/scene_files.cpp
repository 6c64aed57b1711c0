#include "povray_gen/scene_files.hpp"

#include <cmath>
#include <filesystem>
#include <memory>
#include <set>

#include "povray_gen/run.hpp"
#include "povray_gen/scene_text.hpp"
#include "povray_gen/stale_files.hpp"
#include "sardf/error.hpp"
#include "sardf/output_file.hpp"

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
  const SceneDescription& d = scene.description();
  PovrayScene text;
  const std::string stem = fs::path(files.path).stem();
  text.title = d.title.empty() ? stem : d.title;
  text.solid = scene.drawn();
  text.bounds = scene.bounds();
  for (const NamedField& named : scene.fields()) {
    text.fields.push_back({named.name, named.field.expression()});
  }
  const std::vector<std::string> materials = scene.material_names();
  for (size_t i = 0; i < scene.fractions().size(); ++i) {
    text.fractions.push_back({materials.at(i), scene.fractions()[i]});
    text.material_colors.push_back(d.materials.at(i).color);
  }
  text.color = scene.base_color();
  text.camera = files.camera;
  text.width = files.width;
  text.height = files.height;
  text.look = look_of(files.look);
  text.stated_lipschitz = d.stated_lipschitz;
  const fs::path include = fs::path(files.path).replace_extension(".inc");
  SamplingOptions sampling;
  sampling.progress = progress;
  sampling.most_samples = std::pow(files.samples, 3);
  sampling.all_fields = files.all_fields;
  const SceneText made = scene_text(text, include.filename(), sampling);
  const std::vector<std::string> earlier = density_files_of(include);
  std::set<std::string> now;
  std::vector<std::unique_ptr<OutputFile>> written;
  const auto begin_file = [&](const fs::path& path) -> OutputFile& {
    written.push_back(std::make_unique<OutputFile>(path));
    return *written.back();
  };
  for (const SampledPointer& sampled : made.sampled) {
    const fs::path file = include.parent_path() / sampled->file();
    sampled->samples().write_to(begin_file(file), progress);
    now.insert(file);
  }
  begin_file(include).write(made.include);
  begin_file(files.path).write(made.scene);
  for (const auto& file : written) file->commit();
  for (const std::string& file : earlier) {
    std::error_code left_over;  // does no harm
    if (!now.contains(file)) fs::remove(file, left_over);
  }
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
