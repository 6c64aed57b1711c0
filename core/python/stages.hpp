// Apart from convert.hpp, which every file of the module includes.
#pragma once

#include <pybind11/pybind11.h>

namespace sardf {

/// Stages for POV-Ray, and pictures compared.
void bind_stages(pybind11::module_& m);

}  // namespace sardf
