#include "stages.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>

#include "povray_gen/run.hpp"
#include "povray_gen/stage_files.hpp"
#include "python_progress.hpp"
#include "sardf/compare_images.hpp"
#include "sardf/error.hpp"
#include "sardf/pulse.hpp"
#include "sardf/stage.hpp"

namespace sardf {

namespace {

using Samples = py::array_t<float, py::array::c_style | py::array::forcecast>;

// The shares of the progress that end with reading, and with writing.
constexpr double read_until = 0.05, written_until = 0.2;

std::vector<std::string> povray_stage(const std::string& text, const std::string& path,
                                      const std::string& render, const std::string& look, int width,
                                      int height, int samples, int light_samples,
                                      const std::string& program, py::object callable) {
  const povray::StageFiles files{path, look, width, height, samples, light_samples, program};
  if (!render.empty()) povray::find_povray(program);
  PythonProgress progress(std::move(callable));
  return progress.run([&](const Progress& report) {
    const Stage stage = stage_from_text(text, "", part_of(report, 0, read_until));
    const std::vector<std::string> sentences =
        povray::write_stage(stage, files, part_of(report, read_until, written_until));
    if (!render.empty()) povray::render_stage(files, render, part_of(report, written_until, 1));
    return sentences;
  });
}

Image picture_from(const Samples& samples, const char* name) {
  if (samples.ndim() != 3 || samples.shape(2) != 4) {
    throw Error(std::string(name) + " has the shape " +
                std::string(py::str(samples.attr("shape"))) + "; (height, width, 4) is accepted");
  }
  Image image{int(samples.shape(1)), int(samples.shape(0)), 4, {}};
  image.samples.assign(samples.data(), samples.data() + samples.size());
  return image;
}

py::array_t<float> array_from(const Image& image) {
  py::array_t<float> out({image.height, image.width, image.channels});
  std::copy(image.samples.begin(), image.samples.end(), out.mutable_data());
  return out;
}

py::dict compare_pictures(const Samples& reference, const Samples& candidate, float factor) {
  const Image first = picture_from(reference, "reference");
  const Image second = picture_from(candidate, "candidate");
  const Comparison numbers =
      compare_images({first, mask_from_alpha(first)}, {second, mask_from_alpha(second)});
  py::dict out;
  out["intersection_over_union"] = numbers.intersection_over_union;
  out["edge_within_half_pixel_share"] = numbers.edge_within_half_pixel_share;
  out["non_finite_pixels"] = numbers.non_finite_pixels;
  out["compared_pixels"] = numbers.color.compared_pixels;
  out["median"] = numbers.color.median;
  out["quantile_99"] = numbers.color.quantile_99;
  out["maximum"] = numbers.color.maximum;
  out["left_out_share"] = numbers.color.left_out_share;
  out["difference"] = array_from(difference_image(first, second, factor));
  return out;
}

}  // namespace

void bind_stages(py::module_& m) {
  m.def(
      "povray_stage", &povray_stage, py::arg("stage"), py::arg("path"), py::arg("render") = "",
      py::arg("look") = "lit", py::arg("width") = 640, py::arg("height") = 480,
      py::arg("samples") = 256, py::arg("light_samples") = 4, py::arg("program") = "",
      py::arg("progress") = py::none(),
      "Writes parts in their places under Blender's lights for POV-Ray 3.7: path (.pov), of each "
      "part an .inc beside it, and density files; renders them to `render` (.exr, linear, with "
      "alpha) unless it is empty. stage: JSON text with camera, world (radiance), lights and "
      "parts, as core/sardf/stage.hpp states. look: lit (matte surfaces, no interreflection), flat "
      "(the colours alone) or normals; samples: as Scene.povray takes it; light_samples: along "
      "each side of an area light and of soft shadows, 1 to 16; program: path of POV-Ray. Returns "
      "sentences of what has no formula. Raises Error, also where POV-Ray is missing; "
      "progress(share) may return False to cancel, which stops POV-Ray and raises Cancelled.");
  m.def(
      "compare_pictures", &compare_pictures, py::arg("reference"), py::arg("candidate"),
      py::arg("factor") = 16.0f,
      "How far two pictures of one scene agree: float32 (height, width, 4), linear, row 0 at the "
      "top; a solid is where alpha is at least 0.5. A dictionary: intersection_over_union and "
      "edge_within_half_pixel_share of the masks; median, quantile_99 and maximum of the largest "
      "difference of the three channels, in steps of 1/255, over compared_pixels, those away from "
      "edges; left_out_share of the others; non_finite_pixels; and difference, (height, width, "
      "3), the absolute difference × factor in [0, 1]. Raises Error for other shapes and for "
      "pictures without any solid.");
}

}  // namespace sardf
