#include "povray_gen/stage_files.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "povray_gen/light_text.hpp"
#include "povray_gen/pending_files.hpp"
#include "povray_gen/run.hpp"
#include "povray_gen/vector_text.hpp"
#include "sardf/error.hpp"
#include "sardf/pulse.hpp"

namespace sardf::povray {

namespace {

namespace fs = std::filesystem;

const std::vector<std::string> looks{"lit", "flat", "normals"};

void check(const StageFiles& files) {
  if (!files.path.ends_with(".pov")) {
    throw Error("the output must end in .pov; parts go into .inc files beside it", files.path);
  }
  if (std::find(looks.begin(), looks.end(), files.look) == looks.end()) {
    throw Error("there is no look '" + files.look + "'; accepted are lit, flat, normals" +
                did_you_mean(files.look, looks));
  }
  const auto within = [](const char* name, int value, int low, int high) {
    if (value >= low && value <= high) return;
    throw Error(std::string(name) + " is " + std::to_string(value) + "; " + std::to_string(low) +
                " to " + std::to_string(high) + " is accepted");
  };
  within("samples", files.samples, 8, 512);
  within("light_samples", files.light_samples, 1, 16);
  within("width", files.width, 1, 16384);
  within("height", files.height, 1, 16384);
}

// The box around the parts where they stand.
BoundingBox bounds_of(const Stage& stage) {
  BoundingBox all{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
  for (const StagePart& part : stage.parts) {
    const BoundingBox& box = part.scene->bounds();
    for (int corner = 0; corner < 8; ++corner) {
      for (int i = 0; i < 3; ++i) {
        double at = part.matrix_world[i][3];
        for (int j = 0; j < 3; ++j) {
          at += part.matrix_world[i][j] * (corner >> j & 1 ? box.hi[j] : box.lo[j]);
        }
        all.lo[i] = std::min(all.lo[i], at);
        all.hi[i] = std::max(all.hi[i], at);
      }
    }
  }
  return all;
}

// POV-Ray's rows are the images of the axes.
std::string matrix_text(const Matrix4& m) {
  std::string out = "matrix <";
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 3; ++i) out.append(i + j ? ", " : "").append(number_text(m[i][j]));
  }
  return out + ">";
}

std::string finish_text(const Stage& stage, const std::string& look) {
  if (look != "lit") return "ambient 0 diffuse 0 emission 1";
  return "ambient rgb " + vector_text(stage.world) + " diffuse 1";
}

std::string part_text(const StagePart& part, const std::string& prefix, const std::string& finish,
                      bool normals) {
  return filled(
      "object {\n  {}_isosurface()\n  texture { pigment { {} } finish { {} } }\n  {}\n}\n",
      {prefix, prefix + (normals ? "_normal_pigment" : "_pigment"), finish,
       matrix_text(part.matrix_world)});
}

}  // namespace

std::vector<std::string> write_stage(const Stage& stage, const StageFiles& files,
                                     const Progress& progress) {
  check(files);
  const std::string stem = fs::path(files.path).stem();
  const BoundingBox lit = bounds_of(stage);
  PendingFiles pending;
  std::vector<std::string> sentences;
  std::string scene = "#version 3.7;\nglobal_settings { assumed_gamma 1.0 }\n", objects;
  for (size_t i = 0; i < stage.parts.size(); ++i) {
    const StagePart& part = stage.parts[i];
    const double from = double(i) / double(stage.parts.size());
    const double to = double(i + 1) / double(stage.parts.size());
    const std::string number = std::to_string(i + 1);
    const fs::path include = fs::path(files.path).replace_filename(stem + "_" + number + ".inc");
    PovrayScene text = povray_scene_of(*part.scene, stem);
    // All identifiers begin with it, and two parts may be of one title.
    text.title = "part " + number;
    text.camera = stage.camera;
    text.width = files.width;
    text.height = files.height;
    SamplingOptions sampling;
    sampling.progress = part_of(progress, from, to);
    sampling.most_samples = std::pow(files.samples, 3);
    const SceneText made = pending.add(text, include, sampling);
    sentences.insert(sentences.end(), made.sentences.begin(), made.sentences.end());
    scene += "#include \"" + include.filename().string() + "\"\n";
    objects +=
        part_text(part, made.prefix, finish_text(stage, files.look), files.look == "normals");
  }
  scene += "\n" + camera_text(stage.camera, files.width, files.height) + "background { rgbt 1 }\n";
  if (files.look == "lit") {
    for (const Light& light : stage.lights) scene += light_text(light, lit, files.light_samples);
  }
  pending.add(files.path, scene + objects);
  pending.commit();
  return sentences;
}

void render_stage(const StageFiles& files, const std::string& image, const Progress& progress) {
  if (fs::path(image).extension() != ".exr") {
    throw Error(
        "the picture ends in '" + fs::path(image).extension().string() + "'; .exr is accepted",
        image);
  }
  RunOptions options;
  options.width = files.width;
  options.height = files.height;
  options.progress = progress;
  options.program = files.program;
  render(files.path, image, options);
}

}  // namespace sardf::povray
