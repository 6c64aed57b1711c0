#include "convert.hpp"
#include "sardf/error.hpp"
#include "sardf/mesh.hpp"

namespace sardf {

namespace {

// A copy of a vector of fixed arrays as an (N, K) numpy array.
template <class T, size_t K>
py::array_t<T> rows(const std::vector<std::array<T, K>>& values) {
  py::array_t<T> out({values.size(), K});
  if (!values.empty()) std::copy_n(values[0].data(), values.size() * K, out.mutable_data());
  return out;
}

template <class T, size_t K>
void set_rows(std::vector<std::array<T, K>>& to,
              const py::array_t<T, py::array::c_style | py::array::forcecast>& from) {
  if (from.ndim() != 2 || size_t(from.shape(1)) != K) {
    throw Error("an array has the shape " + std::string(py::str(from.attr("shape"))) + "; (N, " +
                std::to_string(K) + ") is accepted");
  }
  to.resize(size_t(from.shape(0)));
  if (!to.empty()) std::copy_n(from.data(), to.size() * K, to[0].data());
}

template <class T>
using Array = py::array_t<T, py::array::c_style | py::array::forcecast>;

}  // namespace

void bind_meshes(py::module_& m) {
  py::class_<Mesh>(m, "Mesh", "A closed surface of quads, wound counter-clockwise from outside.")
      .def(py::init<>())
      .def_property(
          "vertices", [](const Mesh& s) { return rows(s.vertices); },
          [](Mesh& s, const Array<double>& a) { set_rows(s.vertices, a); }, "(V, 3) scene units.")
      .def_property(
          "faces", [](const Mesh& s) { return rows(s.faces); },
          [](Mesh& s, const Array<uint32_t>& a) { set_rows(s.faces, a); },
          "(F, 4) vertex indices; a triangle repeats its last one.")
      .def_property(
          "normals", [](const Mesh& s) { return rows(s.corner_normals); },
          [](Mesh& s, const Array<double>& a) { set_rows(s.corner_normals, a); },
          "(4 F, 3) unit outward normals, one for each corner of each face.")
      .def_property(
          "uv", [](const Mesh& s) { return rows(s.corner_uv); },
          [](Mesh& s, const Array<double>& a) { set_rows(s.corner_uv, a); },
          "(4 F, 2) texture coordinates in [0, 1], v upwards.")
      .def_property_readonly(
          "creases", [](const Mesh& s) { return rows(s.creases); },
          "(C, 2) vertex pairs across which the normal jumps.");
}

}  // namespace sardf
