#include "sardf/scene.hpp"

#include <functional>

#include "convert.hpp"
#include "povray_gen/run.hpp"
#include "povray_gen/scene_files.hpp"
#include "python_progress.hpp"
#include "sardf/bake_channels.hpp"
#include "sardf/camera_file.hpp"
#include "sardf/error.hpp"
#include "sardf/pulse.hpp"
#include "sardf/render.hpp"
#include "sardf/scene_file.hpp"
#include "sardf/surface.hpp"

namespace sardf {

namespace {

using Points = py::array_t<double, py::array::c_style | py::array::forcecast>;
using ScenePointer = std::shared_ptr<Scene>;

size_t count_points(const Points& points) {
  if (points.ndim() != 2 || points.shape(1) != 3) {
    throw Error("points have the shape " + std::string(py::str(points.attr("shape"))) +
                "; (N, 3) is accepted");
  }
  return size_t(points.shape(0));
}

py::array_t<double> fractions(const Scene& scene, const Points& points,
                              const std::string& outside) {
  if (outside != "extend" && outside != "nan") {
    throw Error("outside is '" + outside + "'; accepted are 'extend' and 'nan'" +
                did_you_mean(outside, {"extend", "nan"}));
  }
  const size_t n = count_points(points);
  py::array_t<double> out({n, scene.fractions().size()});
  double* to = out.mutable_data();
  const double* from = points.data();
  py::gil_scoped_release release;
  scene.fractions_at(from, n, to, outside == "nan");
  return out;
}

// A scalar attribute gives (N,), a vector (N, components), named components {name: (N,)}.
py::object attribute_values(const Evaluator& evaluator, const std::vector<std::string>& names,
                            const Points& points) {
  const size_t n = count_points(points), outputs = evaluator.outputs();
  std::vector<size_t> shape{n};
  if (outputs > 1 || !names.empty()) shape.push_back(outputs);
  py::array_t<double> values(shape);
  evaluator.values(points.data(), n, values.mutable_data());
  if (names.empty()) return values;
  py::dict by_name;
  for (size_t c = 0; c < outputs; ++c) {
    py::array_t<double> column(n);
    for (size_t i = 0; i < n; ++i) column.mutable_data()[i] = values.data()[i * outputs + c];
    by_name[names[c].c_str()] = column;
  }
  return by_name;
}

py::dict attributes(const Scene& scene) {
  py::dict out;
  for (const Attribute& attribute : scene.description().attributes) {
    std::vector<Expression> components;
    for (const Field& f : attribute.components) components.push_back(f.expression());
    out[attribute.name.c_str()] = py::cpp_function(
        [evaluator = Evaluator(components), names = attribute.component_names](
            const Points& points) { return attribute_values(evaluator, names, points); },
        py::arg("points"));
  }
  return out;
}

py::object camera(const Scene& scene, int width, int height) {
  return py::module_::import("json").attr("loads")(camera_text(scene_camera(scene, width, height)));
}

Mesh mesh(const Scene& scene, int resolution, double cell_size, bool sections, int size, int gutter,
          py::object callable) {
  PythonProgress progress(std::move(callable));
  return progress.run([&](const Progress& report) {
    SurfaceOptions options;
    options.resolution = resolution;
    options.cell_size = cell_size;
    options.sections = sections;
    options.texture_size = size;
    options.gutter = gutter;
    return make_surface(scene, options, report);
  });
}

py::array_t<float> to_array(Image&& image) {
  auto* samples = new ImageSamples(std::move(image.samples));
  const py::capsule owner(samples, [](void* p) { delete static_cast<ImageSamples*>(p); });
  return py::array_t<float>({image.height, image.width, image.channels}, samples->data(), owner);
}

py::dict bake_maps(const Scene& scene, const Mesh& surface, int size,
                   const std::vector<std::string>& channels, int gutter, bool sections,
                   py::object callable) {
  PythonProgress progress(std::move(callable));
  const std::vector<BakeChannel> wanted = scene_channels(scene, channels);
  std::vector<Image> images = progress.run([&](const Progress& report) {
    const TexelMap texels(surface, size, gutter, part_of(report, 0, 0.1));
    return bake_images(texels, sections ? scene.drawn() : scene.solid(), wanted,
                       part_of(report, 0.1, 1));
  });
  py::dict out;
  for (size_t i = 0; i < wanted.size(); ++i) {
    out[wanted[i].name.c_str()] = to_array(std::move(images[i]));
  }
  return out;
}

Camera camera_from(const Scene& scene, const py::object& camera, int width, int height) {
  if (camera.is_none()) return scene_camera(scene, width, height);
  return camera_from_text(py::str(py::module_::import("json").attr("dumps")(camera)));
}

py::array_t<float> render_scene(const Scene& scene, int width, int height, const std::string& look,
                                const py::object& camera, std::optional<double> tolerance,
                                std::optional<Vec3> background, bool depth, bool normals,
                                int samples, int threads, py::object callable) {
  RenderOptions options;
  options.look = render_look(look);
  options.camera = camera_from(scene, camera, width, height);
  options.width = width;
  options.height = height;
  options.tolerance = tolerance;
  options.background = background;
  options.depth = depth;
  options.normals = normals;
  options.samples = samples;
  options.threads = threads;
  PythonProgress progress(std::move(callable));
  return to_array(
      progress.run([&](const Progress& report) { return render(scene, options, report).image; }));
}

void write_povray(const Scene& scene, const std::string& path, const std::string& render,
                  const py::object& camera, const std::string& look, int width, int height,
                  int samples, bool all_fields, py::object callable) {
  povray::SceneFiles files{path, look, {}, width, height, samples, all_fields};
  files.camera = camera_from(scene, camera, width, height);
  if (!render.empty()) povray::find_povray();
  PythonProgress progress(std::move(callable));
  progress.run([&](const Progress& report) {
    povray::write_files(scene, files, report);
    if (!render.empty()) povray::render_files(files, render, report);
    return true;
  });
}

ScenePointer with_section(const Scene& scene, const Field& remove, std::vector<Field> keep) {
  SceneDescription description = scene.description();
  description.sections.push_back({remove, std::move(keep)});
  return std::make_shared<Scene>(std::move(description));
}

py::dict fields(const Scene& scene) {
  py::dict all;
  for (const NamedField& named : scene.fields()) all[named.name.c_str()] = named.field;
  return all;
}

ScenePointer with_blend(const Scene& scene, const std::shared_ptr<Blend>& blend) {
  SceneDescription description = scene.description();
  description.blend = blend;
  return std::make_shared<Scene>(std::move(description));
}

std::vector<std::string> warnings(const Scene& scene, py::object callable) {
  PythonProgress progress(std::move(callable));
  const std::vector<Warning> found =
      progress.run([&](const Progress& report) { return scene.warnings(report); });
  std::vector<std::string> messages;
  for (const Warning& warning : found) messages.push_back(warning.message);
  return messages;
}

// Fields that are solved for while the description is read report, too.
ScenePointer read_with(py::object callable, const std::function<SceneDescription()>& read) {
  return PythonProgress(std::move(callable)).run([&](const Progress& progress) {
    auto scene = std::make_shared<Scene>(read());
    if (!progress(1)) throw Cancelled();
    return scene;
  });
}

ScenePointer from_json(const std::string& text, const std::map<std::string, Field>& fields,
                       py::object callable) {
  return read_with(std::move(callable), [&] { return parse_scene(text, "", fields); });
}

ScenePointer load(const std::string& path, py::object callable) {
  return read_with(std::move(callable), [&] { return read_scene(path); });
}

}  // namespace

void bind_scenes(py::module_& m) {
  py::class_<Scene, ScenePointer>(m, "Scene", "A solid, what it is made of, and how it is shown.")
      .def_static(
          "from_json", &from_json, py::arg("text"),
          py::arg("fields") = std::map<std::string, Field>{}, py::arg("progress") = py::none(),
          "A scene from a scene file's text; `fields` are names it may use besides its own. "
          "progress: as load() takes it.")
      .def(
          "to_json", [](const Scene& s) { return scene_text(s.description(), {}, "."); },
          "The scene as a scene file's text.")
      .def(
          "save", [](const Scene& s, const std::string& p) { write_scene(p, s.description()); },
          py::arg("path"), "Writes a scene file.")
      .def_property_readonly("title", [](const Scene& s) { return s.description().title; })
      .def_property_readonly("units", [](const Scene& s) { return s.description().units; })
      .def_property_readonly("metres_per_unit", &Scene::metres_per_unit)
      .def_property_readonly("materials", &Scene::material_names, "Names, in order.")
      .def_property_readonly("solid", &Scene::solid_field)
      .def_property_readonly("fields", &fields, "{name: Field} of the scene's named fields.")
      .def_property_readonly(
          "drawn", [](const Scene& s) { return Field(s.drawn(), {}, nullptr); },
          "The solid with its sections cut away.")
      .def_property_readonly(
          "bounds", [](const Scene& s) { return py::make_tuple(s.bounds().lo, s.bounds().hi); },
          "Certified (lo, hi): outside them the solid is proven empty.")
      .def_property_readonly("section_count",
                             [](const Scene& s) { return s.description().sections.size(); })
      .def("fractions", &fractions, py::arg("points"), py::arg("outside") = "extend",
           "Volume fractions at points (N, 3): (N, materials), rows sum to 1. outside='nan' marks "
           "points outside the solid.")
      .def_property_readonly("attributes", &attributes,
                             "{name: function of points (N, 3)} that gives (N,), of a vector (N, "
                             "components), and of named components {name: (N,)}.")
      .def("warnings", &warnings, py::arg("progress") = py::none(),
           "What is accepted but may not be what is meant, as a list of sentences: features that "
           "touch with contradicting values, functions not proven to lie in [0, 1].")
      .def("mesh", &mesh, py::arg("resolution") = 128, py::arg("cell_size") = 0.0,
           py::arg("sections") = true, py::arg("size") = 2048, py::arg("gutter") = 8,
           py::arg("progress") = py::none(),
           "The surface with texture coordinates for a texture of `size`². resolution: cells along "
           "the longest side; cell_size (scene units) instead when > 0. progress(share) may return "
           "False to cancel, which raises Cancelled.")
      .def("bake", &bake_maps, py::arg("mesh"), py::arg("size") = 2048,
           py::arg("channels") = std::vector<std::string>{"base_color", "fractions"},
           py::arg("gutter") = 8, py::arg("sections") = true, py::arg("progress") = py::none(),
           "{channel: float32 (size, size, components)}, row 0 at the top, linear. Channels: "
           "base_color, roughness, metallic, emission, fractions (as fractions_1, ... of three "
           "materials each), field, normal (a tangent-space normal map, for which the mesh needs "
           "normals), density where every material states one, and attributes by name: see "
           "channels().")
      .def("camera", &camera, py::arg("width") = 640, py::arg("height") = 480,
           "A camera that frames the object: matrix_world, lens (mm), sensor_width, ...")
      .def("povray", &write_povray, py::arg("path"), py::arg("render") = "",
           py::arg("camera") = py::none(), py::arg("look") = "shaded", py::arg("width") = 640,
           py::arg("height") = 480, py::arg("samples") = 256, py::arg("all_fields") = false,
           py::arg("progress") = py::none(),
           "Writes path (.pov), the .inc beside it, and density files (.df3) of what has no "
           "formula, "
           "whose errors, and those of all that is computed from them, the .inc states, for "
           "POV-Ray 3.7; renders them to `render` "
           "(.exr or .png) unless it is empty. camera: as camera() gives it; look: shaded, flat "
           "(the colours alone) or normals; samples: the most of what has no formula, as the edge "
           "of "
           "a cube, 8 to 512; all_fields: also write the fields that need samples which the "
           "picture does not.")
      .def("render", &render_scene, py::arg("width") = 640, py::arg("height") = 480,
           py::arg("look") = "shaded", py::arg("camera") = py::none(),
           py::arg("tolerance") = py::none(), py::arg("background") = py::none(),
           py::arg("depth") = false, py::arg("normals") = false, py::arg("samples") = 1,
           py::arg("threads") = 0, py::arg("progress") = py::none(),
           "A picture by certified ray casting: float32 (height, width, 4), row 0 at the top, "
           "linear colour times alpha, then alpha. look: shaded, flat (the colours alone) or "
           "normals (0.5 + 0.5 n). camera: as camera() gives it. tolerance (scene units): no "
           "stretch of the solid that is longer along a ray is missed; none: 1e-4 of the bounds' "
           "diagonal. background: linear (r, g, b); none: alpha is 0 there. depth: one channel "
           "more, the depth along the view in scene units, inf where nothing is. normals: three "
           "channels more, the outward unit normal. samples: rays along each side of a pixel, 1 to "
           "8, "
           "more smooth edges. threads: at most so many, 0: all; the picture "
           "does not depend on it.")
      .def("with_blend", &with_blend, py::arg("blend"),
           "The scene with every union, intersection and difference joined by `blend` in place of "
           "its own.")
      .def("section", &with_section, py::arg("remove"), py::arg("keep") = std::vector<Field>{},
           "The scene with one more cut: `remove` is taken away, the `keep` solids stay whole.");
  m.def("load", &load, py::arg("path"), py::arg("progress") = py::none(),
        "Reads a scene file, and solves for its fitted fields. Raises Error with all that is wrong "
        "in it. progress(share) may return False to cancel, which raises Cancelled.");
  m.def("schema", &scene_schema, "The JSON Schema of scene files, as text.");
}

}  // namespace sardf
