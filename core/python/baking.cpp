// What a bake offers and needs to know beforehand: channels, checks of UV maps, OSL.
#include "convert.hpp"
#include "python_progress.hpp"
#include "sardf/bake_channels.hpp"
#include "sardf/osl_text.hpp"
#include "sardf/pulse.hpp"
#include "sardf/uv_check.hpp"

namespace sardf {

namespace {

const Expression& solid_of(const Scene& scene, bool sections) {
  return sections ? scene.drawn() : scene.solid();
}

py::dict channels(const Scene& scene) {
  py::dict out;
  for (const ChannelInfo& info : channel_infos(scene)) out[info.name.c_str()] = info.doc;
  return out;
}

py::dict image_components(const Scene& scene, const std::vector<std::string>& names) {
  py::dict out;
  for (const BakeChannel& channel : scene_channels(scene, names))
    out[channel.name.c_str()] = channel.tangent_normal ? 3 : channel.components.size();
  return out;
}

py::dict check_uv_of(const Mesh& mesh, int size, int gutter, py::object callable) {
  PythonProgress progress(std::move(callable));
  const UvReport report = progress.run([&](const Progress& tell) {
    return check_uv(TexelMap(mesh, size, gutter, part_of(tell, 0, 0.5)), part_of(tell, 0.5, 1));
  });
  py::dict out;
  out["texels"] = report.texels;
  out["overlapping"] = report.overlapping;
  out["faces"] = report.faces;
  out["outside"] = report.outside;
  out["texels_per_unit"] = report.texels_per_unit;
  return out;
}

py::dict check_surface_of(const Scene& scene, const Mesh& mesh, double tolerance, bool sections) {
  SurfaceReport report;
  {
    py::gil_scoped_release release;
    report = check_surface(mesh, solid_of(scene, sections), tolerance);
  }
  py::dict out;
  out["vertices"] = report.vertices;
  out["off"] = report.off;
  out["farthest"] = report.farthest;
  return out;
}

py::tuple osl_of(const Scene& scene, const std::vector<std::string>& names,
                 const std::string& shader_name) {
  const OslShader shader = osl_shader(scene, names, shader_name);
  py::dict outputs;
  for (const OslOutput& output : shader.outputs) outputs[output.name.c_str()] = output.meaning;
  return py::make_tuple(shader.text, outputs);
}

template <class F, class... Extra>
void add_method(const py::object& type, const char* name, F f, const Extra&... extra) {
  type.attr(name) = py::cpp_function(f, py::name(name), py::is_method(type), extra...);
}

}  // namespace

void bind_baking(py::module_& m) {
  const py::object scene = m.attr("Scene");
  add_method(scene, "channels", &channels,
             "{name: what it is} of all that bake() accepts for this scene.");
  add_method(scene, "image_components", &image_components, py::arg("channels"),
             "{image: its number of components} of what bake() makes of the channels.");
  add_method(m.attr("Mesh"), "check_uv", &check_uv_of, py::arg("size") = 2048,
             py::arg("gutter") = 8, py::arg("progress") = py::none(),
             "What a bake would find of the UV map: texels on the mesh; overlapping, those "
             "on more than one triangle; faces, and how many reach outside [0, 1]; "
             "texels_per_unit, the root of texels per square scene unit.");
  add_method(scene, "check_surface", &check_surface_of, py::arg("mesh"), py::arg("tolerance"),
             py::arg("sections") = true,
             "How far the mesh's vertices lie off the solid's surface, by |f| / |grad f|: "
             "vertices, how many are off by more than the tolerance, and the farthest distance, "
             "in scene units.");
  add_method(scene, "osl", &osl_of, py::arg("channels") = std::vector<std::string>{"base_color"},
             py::arg("name") = "sardf_part",
             "(text, {output: what it is}) of an OSL shader that computes the channels exactly "
             "where a ray hits; fractions are an output for each material. The object's space has "
             "to be the scene's frame. Raises Error for a field without a formula.");
  m.def("texels_per_unit", &texels_per_unit, py::arg("mesh"), py::arg("size"),
        "The root of texels per square scene unit over the whole mesh, for a texture of size².");
  m.def("is_color", &is_color_channel, py::arg("channel"),
        "Whether a channel holds linear colours; all others are data.");
}

}  // namespace sardf
