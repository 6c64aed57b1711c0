// sardf._image: image files, apart from _core because it links OpenImageIO.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "sardf/error.hpp"
#include "sardf/image_file.hpp"

namespace py = pybind11;

namespace sardf {

namespace {

using Samples = py::array_t<float, py::array::c_style | py::array::forcecast>;

Image image_from(const Samples& samples) {
  if (samples.ndim() != 3) throw Error("an image has the shape (height, width, channels)");
  Image image;
  image.height = int(samples.shape(0));
  image.width = int(samples.shape(1));
  image.channels = int(samples.shape(2));
  image.samples.assign(samples.data(), samples.data() + samples.size());
  return image;
}

Samples array_from(const Image& image) {
  Samples out({image.height, image.width, image.channels});
  std::copy(image.samples.begin(), image.samples.end(), out.mutable_data());
  return out;
}

Meaning meaning_of(bool color) { return color ? Meaning::color : Meaning::data; }

Depth depth_of(int bits, bool is_float) {
  if (is_float) return bits == 16 ? Depth::half16 : Depth::float32;
  return bits == 8 ? Depth::byte8 : Depth::byte16;
}

}  // namespace

}  // namespace sardf

PYBIND11_MODULE(_image, m) {
  using namespace sardf;
  m.doc() = "Image files through OpenImageIO. Samples are linear, row 0 at the top.";
  // sardf.Error of the core serves here too.
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Error& error) {
      const py::object type = py::module_::import("sardf._core").attr("Error");
      py::object instance = type(std::string(error.what()));
      instance.attr("file") = error.file;
      instance.attr("line") = error.line;
      instance.attr("pointer") = error.pointer;
      instance.attr("message") = error.message;
      PyErr_SetObject(type.ptr(), instance.ptr());
    }
  });
  m.def(
      "read",
      [](const std::string& path, bool color) {
        return array_from(read_image(path, meaning_of(color)));
      },
      py::arg("path"), py::arg("color") = true,
      "float32 (height, width, channels), linear when `color`.");
  m.def(
      "write",
      [](const std::string& path, const Samples& samples, bool color, int bits,
         const std::vector<std::string>& names) {
        const bool is_float = path.ends_with(".exr");
        write_image(path, image_from(samples), meaning_of(color), depth_of(bits, is_float), names);
      },
      py::arg("path"), py::arg("samples"), py::arg("color") = true, py::arg("bits") = 16,
      py::arg("names") = std::vector<std::string>{},
      "Writes EXR (bits 16 or 32, linear) or PNG (bits 8 or 16; sRGB when `color`).");
}
