#include "povray_gen/pending_files.hpp"

#include "povray_gen/stale_files.hpp"

namespace sardf::povray {

namespace fs = std::filesystem;

PovrayScene povray_scene_of(const Scene& scene, const std::string& title) {
  const SceneDescription& d = scene.description();
  PovrayScene text;
  text.title = d.title.empty() ? title : d.title;
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
  text.stated_lipschitz = d.stated_lipschitz;
  return text;
}

OutputFile& PendingFiles::begin(const fs::path& path) {
  files_.push_back(std::make_unique<OutputFile>(path));
  return *files_.back();
}

SceneText PendingFiles::add(const PovrayScene& scene, const fs::path& include,
                            const SamplingOptions& sampling) {
  SceneText made = scene_text(scene, include.filename(), sampling);
  for (std::string& file : density_files_of(include)) earlier_.push_back(std::move(file));
  for (const SampledPointer& sampled : made.sampled) {
    const fs::path file = include.parent_path() / sampled->file();
    sampled->samples().write_to(begin(file), sampling.progress);
    now_.insert(file);
  }
  begin(include).write(made.include);
  return made;
}

void PendingFiles::add(const fs::path& path, const std::string& text) { begin(path).write(text); }

void PendingFiles::commit() {
  for (const auto& file : files_) file->commit();
  for (const std::string& file : earlier_) {
    std::error_code left_over;  // does no harm
    if (!now_.contains(file)) fs::remove(file, left_over);
  }
}

}  // namespace sardf::povray
