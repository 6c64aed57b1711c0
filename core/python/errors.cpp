#include "convert.hpp"
#include "sardf/error.hpp"

namespace sardf {

namespace {

// Owned by the module, which lives as long as the interpreter.
PyObject* error_type = nullptr;
PyObject* cancelled_type = nullptr;

void raise(const Error& error) {
  py::object instance = py::reinterpret_borrow<py::object>(error_type)(std::string(error.what()));
  instance.attr("file") = error.file;
  instance.attr("line") = error.line;
  instance.attr("pointer") = error.pointer;
  instance.attr("message") = error.message;
  PyErr_SetObject(error_type, instance.ptr());
}

}  // namespace

void bind_errors(py::module_& m) {
  error_type = py::exception<Error>(m, "Error", PyExc_ValueError).release().ptr();
  cancelled_type = py::exception<Cancelled>(m, "Cancelled").release().ptr();
  py::reinterpret_borrow<py::object>(error_type).attr("__doc__") =
      "Bad input. file, line and pointer say where, message what and what is accepted.";
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Error& error) {
      raise(error);
    } catch (const Cancelled& cancelled) {
      PyErr_SetString(cancelled_type, cancelled.what());
    }
  });
}

}  // namespace sardf
