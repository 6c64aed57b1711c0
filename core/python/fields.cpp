#include "sardf/field.hpp"

#include <cstring>

#include "convert.hpp"
#include "sardf/certify.hpp"
#include "sardf/error.hpp"
#include "sardf/field_parts.hpp"

namespace sardf {

namespace {

py::array as_array(const py::object& points) {
  const py::array array = py::array::ensure(points);
  if (!array || !std::strchr("fiub", array.dtype().kind())) {
    PyErr_Clear();
    throw Error("points are no array of numbers; (N, 3) or (3,) is accepted");
  }
  return array;
}

// (N, 3) points, or one point of shape (3,).
template <class T>
py::array_t<T, py::array::c_style | py::array::forcecast> checked_points(const py::array& points) {
  const bool one = points.ndim() == 1 && points.shape(0) == 3;
  if (!one && !(points.ndim() == 2 && points.shape(1) == 3)) {
    throw Error("points have the shape " + std::string(py::str(points.attr("shape"))) +
                "; (N, 3) or (3,) is accepted");
  }
  return py::array_t<T, py::array::c_style | py::array::forcecast>::ensure(points);
}

template <class T>
py::object values(const Field& field, const py::array& points) {
  const auto at = checked_points<T>(points);
  const size_t n = size_t(at.size()) / 3;
  py::array_t<T> out{py::ssize_t(n)};
  const Evaluator evaluator(field.expression());
  {
    T* to = out.mutable_data();
    const T* from = at.data();
    py::gil_scoped_release release;
    evaluator.values(from, n, to);
  }
  if (points.ndim() == 1) return py::float_(double(out.data()[0]));
  return out;
}

template <class T>
py::object gradients(const Field& field, const py::array& points) {
  const auto at = checked_points<T>(points);
  const size_t n = size_t(at.size()) / 3;
  py::array_t<T> out({n, size_t(3)});
  const Evaluator evaluator(field.expression());
  {
    T* to = out.mutable_data();
    const T* from = at.data();
    py::gil_scoped_release release;
    evaluator.gradients(from, n, static_cast<T*>(nullptr), to);
  }
  if (points.ndim() == 1) return out.attr("reshape")(3);
  return out;
}

// float32 takes the SIMD path, everything else the exact one.
bool is_float32(const py::array& points) { return py::dtype::of<float>().equal(points.dtype()); }

bool is_solid(const py::handle& value) {
  if (!py::isinstance<Field>(value)) return false;
  const Construction* made = py::cast<const Field&>(value).construction();
  return made && made->constructor;
}

Field boolean(const char* constructor, const Field& a, const Field& b) {
  return make_field(constructor, {std::vector<Field>{a, b}, current_blend()});
}

// Between two solids made by constructors, - removes; with a number or a formula it subtracts.
Field minus(const py::object& a, const py::object& b) {
  if (is_solid(a) && is_solid(b)) {
    return boolean("difference", py::cast<Field>(a), py::cast<Field>(b));
  }
  return combine(field_from(a, "the left operand"), '-', field_from(b, "the right operand"));
}

template <char symbol>
Field arithmetic(const py::object& a, const py::object& b) {
  return combine(field_from(a, "the left operand"), symbol, field_from(b, "the right operand"));
}

template <char symbol>
Field reflected(const py::object& a, const py::object& b) {
  return arithmetic<symbol>(b, a);
}

void bind_operators(py::class_<Field>& field) {
  field.def("__add__", &arithmetic<'+'>)
      .def("__radd__", &reflected<'+'>)
      .def("__sub__", &minus)
      .def("__rsub__", [](const py::object& a, const py::object& b) { return minus(b, a); })
      .def("__mul__", &arithmetic<'*'>)
      .def("__rmul__", &reflected<'*'>)
      .def("__truediv__", &arithmetic<'/'>)
      .def("__rtruediv__", &reflected<'/'>)
      .def("__pow__", &arithmetic<'^'>)
      .def("__neg__", &negate)
      .def("__or__", [](const Field& a, const Field& b) { return boolean("union", a, b); })
      .def("__and__", [](const Field& a, const Field& b) { return boolean("intersection", a, b); });
}

const char* exactness_name(Exactness e) {
  return e == Exactness::exact ? "exact" : e == Exactness::bound ? "bound" : "estimate";
}

}  // namespace

void bind_fields(py::module_& m) {
  py::class_<Blend, std::shared_ptr<Blend>>(m, "Blend", "How two fields are joined.")
      .def_readonly("name", &Blend::name)
      .def_readonly("parameters", &Blend::parameters)
      .def("__repr__", [](const Blend& b) {
        std::string text = "<blend " + b.name;
        for (double p : b.parameters) text += " " + std::string(py::str(py::float_(p)));
        return text + ">";
      });
  py::class_<Field> field(m, "Field",
                          "Scalar function of position; for solids positive inside. Between solids "
                          "| & - join with the current blend; + - * / ** do arithmetic.");
  field
      .def(
          "__call__",
          [](const Field& f, const py::object& points) {
            const py::array at = as_array(points);
            return is_float32(at) ? values<float>(f, at) : values<double>(f, at);
          },
          py::arg("points"),
          "Values at points (N, 3): float64 on the exact path, float32 on the SIMD path. (N,)")
      .def(
          "gradient",
          [](const Field& f, const py::object& points) {
            const py::array at = as_array(points);
            return is_float32(at) ? gradients<float>(f, at) : gradients<double>(f, at);
          },
          py::arg("points"),
          "Gradients at points (N, 3). At a kink one branch's; NaN where no direction exists.")
      .def(
          "interval",
          [](const Field& f, const Vec3& lo, const Vec3& hi) {
            const Interval i = Evaluator(f.expression()).interval({lo, hi});
            return py::make_tuple(i.lo, i.hi);
          },
          py::arg("lo"), py::arg("hi"), "Certified (low, high) of the values over the box.")
      .def(
          "lipschitz",
          [](const Field& f, const Vec3& lo, const Vec3& hi) {
            return lipschitz_bound(Evaluator(f.expression()), {lo, hi});
          },
          py::arg("lo"), py::arg("hi"),
          "Certified bound of the gradient's length over the box; may be inf.")
      .def(
          "error_bound", [](const Field& f) { return error_bound(f.expression()); },
          "Certified max |f - the same tree with min/max|; inf for r_function.")
      .def_property_readonly(
          "exactness",
          [](const Field& f) {
            return py::make_tuple(exactness_name(f.quality().inside),
                                  exactness_name(f.quality().outside));
          },
          "('exact' | 'bound' | 'estimate') inside and outside.")
      .def_property_readonly(
          "is_distance", &is_distance,
          "Whether its values are distances in scene units, or estimates of them as blends make; "
          "not of formulas and functions.");
  bind_operators(field);
}

}  // namespace sardf
