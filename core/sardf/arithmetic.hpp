// Arithmetic on expressions, for everything that builds graphs.
#pragma once

#include "sardf/graph.hpp"

namespace sardf {

Expression operator+(const Expression& a, const Expression& b);
Expression operator-(const Expression& a, const Expression& b);
Expression operator*(const Expression& a, const Expression& b);
Expression operator/(const Expression& a, const Expression& b);
Expression operator-(const Expression& a);
Expression min(const Expression& a, const Expression& b);
Expression max(const Expression& a, const Expression& b);
Expression abs(const Expression& a);
Expression exp(const Expression& a);
Expression log(const Expression& a);
Expression length(const Expression& a, const Expression& b);
/// a to the power b; a product of factors where b is a whole constant.
Expression pow(const Expression& a, const Expression& b);
/// 1 where a < b (a <= b), else 0.
Expression less(const Expression& a, const Expression& b);
Expression less_equal(const Expression& a, const Expression& b);
/// b where the condition is not 0, else c.
Expression select(const Expression& condition, const Expression& b, const Expression& c);
/// row · (x, y, z) + offset; a coordinate itself where that is all it is.
Expression affine(const std::array<Expression, 3>& xyz, const Vec3& row, double offset);
/// Any function of the formula language by name.
Expression function(const char* name, std::initializer_list<Expression> inputs);

}  // namespace sardf
