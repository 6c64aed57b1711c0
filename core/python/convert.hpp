// Python values to the core's and back.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "sardf/constructor.hpp"
#include "sardf/evaluate.hpp"

namespace sardf {

namespace py = pybind11;

/// Registers sardf.Error and sardf.Cancelled.
void bind_errors(py::module_& m);
void bind_fields(py::module_& m);
void bind_constructors(py::module_& m);
void bind_scenes(py::module_& m);
void bind_meshes(py::module_& m);
/// What scenes give for previews; after bind_scenes.
void bind_volume_samples(py::module_& m);
/// What bakes need besides; after bind_scenes.
void bind_baking(py::module_& m);

/// A Field, a number, or a formula's text as a field; Error naming the parameter otherwise.
Field field_from(const py::handle& value, const std::string& parameter);

/// One parameter's value. Throws Error: what was found, what is accepted.
Value value_from(const ParameterInfo& parameter, const py::handle& value);

/// The arguments in the parameters' order from positional and keyword arguments; `takes` names the
/// constructor in errors.
std::vector<Value> arguments_from(const std::string& takes,
                                  const std::vector<ParameterInfo>& parameters, int variadic,
                                  const py::args& args, const py::kwargs& kwargs);

/// "box(center=(0, 0, 0), size, ...)": a line for a docstring.
std::string signature(const std::string& name, const std::vector<ParameterInfo>& parameters,
                      int variadic, bool takes_progress = false);
/// The signature, what it makes, and a line for each parameter.
std::string docstring(const std::string& name, const std::string& doc,
                      const std::vector<ParameterInfo>& parameters, int variadic,
                      bool takes_progress = false);

/// The blend that booleans take when none is given; set by `with sardf.blend(...)`.
BlendPointer& current_blend();

}  // namespace sardf
