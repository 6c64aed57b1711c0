// sardf._core: the compiled core as a Python module. It links no image library, so that it can live
// inside Blender, which has its own.
#include "convert.hpp"
#include "stages.hpp"

PYBIND11_MODULE(_core, m) {
  m.doc() = "Heterogeneous solids by distances: the compiled core.";
  m.attr("__version__") = SARDF_VERSION;
  sardf::bind_errors(m);
  sardf::bind_fields(m);
  sardf::bind_constructors(m);
  sardf::bind_meshes(m);
  sardf::bind_scenes(m);
  sardf::bind_volume_samples(m);
  sardf::bind_stages(m);
  sardf::bind_baking(m);
}
