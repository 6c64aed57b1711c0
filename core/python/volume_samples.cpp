#include "sardf/volume_samples.hpp"

#include "convert.hpp"
#include "python_progress.hpp"
#include "sardf/bake_channels.hpp"
#include "sardf/error.hpp"
#include "sardf/first_point.hpp"

namespace sardf {

namespace {

// numpy takes the samples over.
py::array_t<float> to_array(std::unique_ptr<float[]> samples,
                            const std::vector<py::ssize_t>& shape) {
  float* first = samples.release();
  const py::capsule owner(first, [](void* p) { delete[] static_cast<float*>(p); });
  return py::array_t<float>(shape, first, owner);
}

Expression fraction_of(const Scene& scene, const std::string& material) {
  const std::vector<std::string> names = scene.material_names();
  for (size_t m = 0; m < names.size(); ++m) {
    if (names[m] == material) return scene.fractions()[m];
  }
  std::string accepted;
  for (const std::string& name : names) accepted += (accepted.empty() ? "" : ", ") + name;
  throw Error("there is no material '" + material + "'; accepted are " + accepted +
              did_you_mean(material, names));
}

std::vector<Expression> components_of(const Scene& scene, const std::string& channel,
                                      const std::string& material) {
  if (channel == "fractions") return {fraction_of(scene, material)};
  const std::vector<BakeChannel> channels = scene_channels(scene, {channel});
  if (channels.size() != 1) {
    throw Error("'" + channel + "' has components that are a channel each; one channel of 1 to 3 " +
                "components is accepted");
  }
  return channels[0].components;
}

py::dict sample_volume_of(const Scene& scene, const Vec3& lo, const Vec3& hi,
                          const std::array<int, 3>& counts, bool sections,
                          const std::string& colors, const std::string& channel,
                          const std::string& material, py::object callable) {
  VolumeSampling sampling;
  sampling.grid = {{lo, hi}, counts};
  sampling.sections = sections;
  sampling.colored = colored_samples(colors);
  sampling.components = components_of(scene, channel, material);
  PythonProgress progress(std::move(callable));
  VolumeSamples samples =
      progress.run([&](const Progress& report) { return sample_volume(scene, sampling, report); });
  std::vector<py::ssize_t> shape{counts[2], counts[1], counts[0]};
  py::dict out;
  out["field"] = to_array(std::move(samples.field), shape);
  shape.push_back(4);
  out["color"] = samples.colors ? py::object(to_array(std::move(samples.colors), shape))
                                : py::object(py::none());
  out["steepness"] = samples.steepness;
  out["range"] = samples.range.lo <= samples.range.hi
                     ? py::object(py::make_tuple(samples.range.lo, samples.range.hi))
                     : py::object(py::none());
  return out;
}

py::dict material_colors(const Scene& scene) {
  py::dict colors;
  for (const Material& material : scene.description().materials) {
    colors[material.name.c_str()] = py::tuple(py::cast(material.color));
  }
  return colors;
}

}  // namespace

void bind_volume_samples(py::module_& m) {
  const py::object scene = m.attr("Scene");
  scene.attr("sample_volume") = py::cpp_function(
      &sample_volume_of, py::name("sample_volume"), py::is_method(scene), py::arg("lo"),
      py::arg("hi"), py::arg("counts"), py::arg("sections") = true, py::arg("colors") = "surface",
      py::arg("channel") = "base_color", py::arg("material") = "", py::arg("progress") = py::none(),
      "Samples for 3-D textures, on a grid of counts = (nx, ny, nz) cells over the box from lo to "
      "hi (scene units), in the cells' middles. {'field': float32 (nz, ny, nx), of the drawn solid "
      "or, without sections, of the whole one, positive inside; 'color': float32 (nz, ny, nx, 4), "
      "linear, its last component 1 where there is a colour and all 0 elsewhere; 'steepness': the "
      "interpolated field's largest slope at most; 'range': least and largest first component, or "
      "None}. colors: 'surface', where interpolation on the surface needs them, 'inside', wherever "
      "a cut may show them, or 'none'. channel: base_color or another one that bake() knows, with "
      "1 to 3 components; 'fractions' is that of `material`. progress(share) may return False to "
      "cancel, which raises Cancelled.");
  scene.attr("first_point") = py::cpp_function(
      [](const Scene& s, const Vec3& origin, const Vec3& direction, const Plane& plane) {
        return first_point(s, origin, direction, plane);
      },
      py::name("first_point"), py::is_method(scene), py::arg("origin"), py::arg("direction"),
      py::arg("plane") = Plane{}, py::call_guard<py::gil_scoped_release>(),
      "The first point (x, y, z) of the drawn solid on a ray, or None. plane (a, b, c, d): what "
      "has a x + b y + c z + d > 0 is cut away, too. A wall thinner along the ray than a "
      "thousandth of the bounds may be missed.");
  const py::object property = py::module_::import("builtins").attr("property");
  scene.attr("material_colors") =
      property(py::cpp_function(&material_colors, py::is_method(scene)), py::none(), py::none(),
               "{name: (red, green, blue)}, linear, in order.");
}

}  // namespace sardf
