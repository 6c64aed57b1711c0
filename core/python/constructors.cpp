// One Python function for each constructor and one class-like function for each blend, by loops
// over the registries.
#include "convert.hpp"
#include "python_progress.hpp"
#include "sardf/error.hpp"
#include "sardf/formula.hpp"

namespace sardf {

namespace {

// "sardf_c1" -> "SardfC1".
std::string camel_case(const std::string& name) {
  std::string out;
  bool upper = true;
  for (char c : name) {
    if (c == '_') {
      upper = true;
    } else {
      out += upper ? char(std::toupper(c)) : c;
      upper = false;
    }
  }
  return out;
}

Field make_long(const Constructor& constructor, const py::args& args, const py::kwargs& kwargs) {
  py::dict others(kwargs);
  py::object callable = py::none();
  if (kwargs.contains("progress")) callable = others.attr("pop")("progress");
  std::vector<Value> arguments =
      arguments_from(constructor.name, constructor.parameters, constructor.variadic(), args,
                     py::reinterpret_borrow<py::kwargs>(others));
  return PythonProgress(std::move(callable)).run([&](const Progress& progress) {
    Field made = make_field(constructor, std::move(arguments));
    if (!progress(1)) throw Cancelled();
    return made;
  });
}

void bind_constructor(py::module_& m, const Constructor& constructor) {
  const std::string doc = docstring(constructor.name, constructor.doc, constructor.parameters,
                                    constructor.variadic(), constructor.takes_progress);
  m.attr(constructor.name.c_str()) = py::cpp_function(
      [&constructor](const py::args& args, const py::kwargs& kwargs) {
        try {
          if (constructor.takes_progress) return make_long(constructor, args, kwargs);
          return make_field(constructor, arguments_from(constructor.name, constructor.parameters,
                                                        constructor.variadic(), args, kwargs));
        } catch (const Error& error) {
          if (error.message.starts_with(constructor.name)) throw;
          throw Error(constructor.name + ": " + error.message);
        }
      },
      py::name(constructor.name.c_str()), py::doc(doc.c_str()), py::scope(m));
}

// For the stub: the position of *fields or -1, and (name, type, required) of each parameter.
py::tuple signature_data(const std::vector<ParameterInfo>& parameters, int variadic,
                         bool takes_progress) {
  py::list rows;
  for (const ParameterInfo& p : parameters) {
    rows.append(py::make_tuple(p.name, type_name(p.type), p.required));
  }
  if (takes_progress) rows.append(py::make_tuple("progress", "a progress", false));
  return py::make_tuple(variadic, rows);
}

Field formula(const std::string& text, const py::kwargs& names) {
  std::map<std::string, Field> fields;
  for (const auto& [name, value] : names) {
    fields[py::cast<std::string>(name)] = field_from(value, py::cast<std::string>(name));
  }
  return parse_formula(text, fields, {});
}

}  // namespace

void bind_constructors(py::module_& m) {
  py::dict constructor_dict, blend_dict, signatures;
  for (const Constructor& constructor : constructors()) {
    bind_constructor(m, constructor);
    constructor_dict[constructor.name.c_str()] = constructor.group;
    signatures[constructor.name.c_str()] =
        signature_data(constructor.parameters, constructor.variadic(), constructor.takes_progress);
  }
  for (const BlendType& type : blend_types()) {
    const std::string name = camel_case(type.name);
    const std::string doc = docstring(name, type.doc, type.parameters, -1);
    m.attr(name.c_str()) = py::cpp_function(
        [&type](const py::args& args, const py::kwargs& kwargs) {
          return std::const_pointer_cast<Blend>(
              make_blend(type.name, arguments_from(type.name, type.parameters, -1, args, kwargs)));
        },
        py::name(name.c_str()), py::doc(doc.c_str()), py::scope(m));
    blend_dict[type.name.c_str()] = name;
    signatures[name.c_str()] = signature_data(type.parameters, -1, false);
  }
  // What the package exports and the stub generator loops over.
  m.attr("_constructors") = constructor_dict;
  m.attr("_blends") = blend_dict;
  m.attr("_signatures") = signatures;
  m.def("formula", &formula, py::arg("text"),
        "formula(text, **names)\n\nA field from a formula over x, y, z, pi and the given fields or "
        "numbers, e.g. formula(\"sin(k*x) + part\", k=2, part=box).");
  m.attr("x") = Field::coordinate(0);
  m.attr("y") = Field::coordinate(1);
  m.attr("z") = Field::coordinate(2);
  m.def("_fail", [](const std::string& message) { throw Error(message); });
  m.def(
      "_set_blend",
      [](const std::shared_ptr<Blend>& blend) {
        return std::const_pointer_cast<Blend>(std::exchange(current_blend(), blend));
      },
      py::arg("blend"), "Sets the blend that booleans take when none is given; the former one.");
}

}  // namespace sardf
