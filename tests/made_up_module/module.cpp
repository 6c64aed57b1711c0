// sardf._core once more, with an operation added: tests/python/test_made_up_operation.py finds it.
#include "core/python/convert.hpp"
#include "tests/cpp/made_up_operation.hpp"

PYBIND11_MODULE(made_up, m) {
  sardf::pear();
  sardf::bind_errors(m);
  sardf::bind_fields(m);
  sardf::bind_constructors(m);
  sardf::bind_meshes(m);
  sardf::bind_scenes(m);
}
