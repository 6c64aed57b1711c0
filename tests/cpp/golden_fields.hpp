// Fields against golden values: what tests of the second paper's figures have in common.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "golden.hpp"
#include "sardf/evaluate.hpp"
#include "sardf/scene_file.hpp"

namespace sardf::golden {

/// So that it reads back as it is.
inline std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}
inline std::string number(const Table& table, const char* name) {
  return number(table.parameter(name).get<double>());
}

/// The named fields of a scene file: `features`, and then more members.
inline std::map<std::string, Field> fields(const std::string& features,
                                           const std::string& members) {
  const std::string text = R"({"sardf": 1, "solid": {"sphere": {"radius": 5}}, "fields": {)" +
                           features + (members.empty() ? "" : ", ") + members + "}}";
  std::map<std::string, Field> all;
  for (const NamedField& named : parse_scene(text, "").fields) all[named.name] = named.field;
  return all;
}

/// Inverse distances to "S" and "ring", each with these members.
inline std::string two(const std::string& first, const std::string& second) {
  return R"({"value_of": {"inverse_distance": {"features": [{"at": "S", )" + first +
         R"(}, {"at": "ring", )" + second + "}]}}}";
}

/// At z = 0 where the file has no z.
inline Vec3 point_of(const Table& table, const std::vector<double>& row) {
  const bool has_z = table.find("z") >= 0;
  return {row[table.column("x")], row[table.column("y")], has_z ? row[table.column("z")] : 0};
}

/// The larger of both counts.
struct Tolerance {
  double absolute = 0, relative = 0;
  double of(double expected) const { return std::max(absolute, relative * std::abs(expected)); }
};

/// Values in `column`, and the gradient in column_gx, ... as far as the file has these; it is NaN
/// where there is none. `slack`: how far the file's values may be off, beyond its tolerance.
inline void expect_field(const Table& table, const Expression& field, const std::string& column,
                         const Tolerance& of_gradient, double slack = 0) {
  const Evaluator evaluator(field);
  const size_t values = table.column(column);
  int places[3];
  for (size_t k = 0; k < 3; ++k) places[k] = table.find(column + "_g" + "xyz"[k]);
  for (const std::vector<double>& row : table.rows) {
    const Vec3 point = point_of(table, row);
    double value;
    Vec3 gradient;
    evaluator.gradients(point.data(), 1, &value, gradient.data());
    ASSERT_NEAR(value, row[values], table.tolerance() + slack) << column;
    for (size_t k = 0; k < 3; ++k) {
      if (places[k] < 0 || std::isnan(row[size_t(places[k])])) continue;
      const double expected = row[size_t(places[k])];
      ASSERT_NEAR(gradient[k], expected, of_gradient.of(expected)) << column << "xyz"[k];
    }
  }
}

}  // namespace sardf::golden
