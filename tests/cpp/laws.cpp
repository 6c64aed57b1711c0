#include "laws.hpp"

#include <gtest/gtest.h>

#include "sardf/operation_of.hpp"
#include "sardf/ops.hpp"

namespace sardf::laws {

namespace {

// Without those that tests add, so that draws do not depend on which tests ran before.
const int own_constructors = int(constructors().size());

// One overload for each type of a parameter.
inline void randomize(Random& r, const Parameter& p, double& to) { to = r.number(p); }
inline void randomize(Random& r, const Parameter&, bool& to) { to = r.chance(0.5); }
inline void randomize(Random& r, const Parameter&, int& to) { to = r.below(9); }
inline void randomize(Random& r, const Parameter&, Axis& to) { to.direction = r.direction(); }
template <size_t N>
void randomize(Random& r, const Parameter& p, std::array<double, N>& to) {
  for (double& a : to) a = r.number(p);
}
template <class T>
void randomize(Random& r, const Parameter& p, std::optional<T>& to) {
  if (r.chance(0.5)) randomize(r, p, to.emplace());
}
inline void randomize(Random& r, const Parameter& p, std::vector<Vec2>& to) {
  to = r.contour(p.at_least + r.below(5));
}
inline void randomize(Random& r, const Parameter& p, std::vector<Vec3>& to) {
  to.resize(size_t(p.at_least + r.below(5)));
  for (Vec3& at : to) randomize(r, p, at);
}

template <class Op>
OperationPointer random_operation(Random& r) {
  return retried([&] {
    Op op{};
    auto visit = [&](const Parameter& p, auto member) { randomize(r, p, op.*member); };
    if constexpr (requires { Op::parameters(visit); }) Op::parameters(visit);
    return make_operation(op);
  });
}

std::vector<ListedOperation> list_operations() {
  std::vector<ListedOperation> all;
  Ops::for_each([&]<class Op>(std::type_identity<Op>) {
    ListedOperation listed{Op::name, &random_operation<Op>, {}};
    if constexpr (is_monotone<Op>) {
      listed.monotone.assign(std::begin(Op::monotone), std::end(Op::monotone));
    }
    listed.hides_jumps = requires { Op::hides_jumps; };
    all.push_back(listed);
  });
  return all;
}

bool takes_fields(const Constructor& constructor) {
  for (const ParameterInfo& p : constructor.parameters) {
    if (p.type == ParameterType::field || p.type == ParameterType::fields ||
        p.type == ParameterType::values)
      return true;
  }
  return false;
}

// A surface costs thousands of formulas: it is tested by itself, and in trees curves stand for it.
bool is_dear(const Constructor& constructor) {
  for (const ParameterInfo& p : constructor.parameters) {
    if (p.type == ParameterType::point_grid) return true;
  }
  return false;
}

// Copies are searched for where they may touch, which takes longer than testing what comes of it.
bool may_be_left_out(Random& r, const Constructor& constructor) {
  return constructor.name == "repeat" && r.chance(0.95);
}

BlendPointer random_blend(Random& r) {
  const BlendType& type = blend_types()[size_t(r.below(int(blend_types().size())))];
  std::vector<Value> arguments;
  for (size_t i = 0; i < type.parameters.size(); ++i) arguments.push_back(r.decades(-1, 0.5));
  return make_blend(type.name, arguments);
}

template <class T>
Value random_of(Random& r, const Parameter& p) {
  T value{};
  randomize(r, p, value);
  return value;
}

Field random_plane_field(Random& r) {
  for (;;) {
    const Constructor& constructor = constructors()[size_t(r.below(own_constructors))];
    if (constructor.group == "plane") return random_field(r, constructor, 0);
  }
}

Value random_value(Random& r, const ParameterInfo& info, int depth) {
  const Parameter p{"", "", info.unit, info.range, info.required, info.at_least};
  // Degrees, knots and weights depend on one another: by default they fit.
  const bool is_bare = info.type == ParameterType::number || info.type == ParameterType::numbers;
  if (is_bare && !info.required && info.unit == Unit::none && r.chance(0.5)) {
    return info.default_value;
  }
  switch (info.type) {
    case ParameterType::boolean:
      return r.chance(0.5);
    case ParameterType::number:
      return r.number(p);
    case ParameterType::optional_number:
      return r.chance(0.5) ? Value() : Value(r.number(p));
    case ParameterType::vector2:
      return random_of<Vec2>(r, p);
    case ParameterType::optional_vector3:
      if (r.chance(0.5)) return {};
      [[fallthrough]];
    case ParameterType::vector3:
      return random_of<Vec3>(r, p);
    case ParameterType::optional_vector4:
      return r.chance(0.5) ? Value() : random_of<std::array<double, 4>>(r, p);
    case ParameterType::axis:
      return r.direction();
    case ParameterType::points2:
      return random_of<std::vector<Vec2>>(r, p);
    case ParameterType::points3:
      return random_of<std::vector<Vec3>>(r, p);
    case ParameterType::numbers: {
      std::vector<double> all(size_t(p.at_least + r.below(5)));
      for (double& a : all) a = r.number(p);
      return all;
    }
    case ParameterType::point_grid: {
      PointGrid grid(size_t(p.at_least + r.below(5)));
      const size_t columns = size_t(2 + r.below(5));
      for (std::vector<Vec3>& row : grid) {
        row.resize(columns);
        for (Vec3& at : row) randomize(r, p, at);
      }
      return grid;
    }
    case ParameterType::optional_field:
      if (r.chance(0.5)) return {};
      [[fallthrough]];
    case ParameterType::field:
      return random_field(r, depth - 1);
    case ParameterType::fields:
    case ParameterType::values: {
      std::vector<Field> fields;
      int n = info.at_least > 1 ? info.at_least : 1 + r.below(3);
      for (; n > 0; --n) fields.push_back(random_field(r, depth - 1));
      return fields;
    }
    case ParameterType::sections: {
      std::vector<PlaneSection> sections;
      double z = r.uniform(-3, 0);
      for (int n = 2 + r.below(3); n > 0; --n) {
        sections.push_back({random_plane_field(r), z += r.uniform(0.5, 2)});
      }
      return sections;
    }
    case ParameterType::blend:
      return random_blend(r);
    default:
      return info.default_value;
  }
}

}  // namespace

const std::vector<ListedOperation>& listed_operations() {
  static const std::vector<ListedOperation> all = list_operations();
  return all;
}

std::vector<double> partials_at(const Operation& op, const std::vector<double>& in) {
  std::array<const double*, max_arity> at{};
  std::array<double*, max_arity> to{};
  std::vector<double> partial(in.size());
  for (size_t k = 0; k < in.size(); ++k) {
    at[k] = &in[k];
    to[k] = &partial[k];
  }
  double value;
  op.partials(at.data(), &value, to.data(), 1);
  EXPECT_TRUE(value == op.evaluate(in.data()) || std::isnan(value));
  return partial;
}

bool can_be_random(const Constructor& constructor) {
  for (const ParameterInfo& p : constructor.parameters) {
    const bool has_none = p.type == ParameterType::text || p.type == ParameterType::rule ||
                          p.type == ParameterType::path || p.type == ParameterType::numbers;
    if (p.required && has_none) return false;
  }
  return true;
}

Field random_field(Random& r, const Constructor& constructor, int depth) {
  return retried([&] {
    std::vector<Value> arguments;
    for (const ParameterInfo& p : constructor.parameters) {
      arguments.push_back(random_value(r, p, depth));
    }
    const Field made = make_field(constructor, arguments);
    // Of distances found by a search there are no third derivatives, which gradients may need.
    const Vec3 at{};
    double value;
    Vec3 slope;
    Evaluator(made.expression()).gradients(at.data(), 1, &value, slope.data());
    return made;
  });
}

Field random_field(Random& r, int depth) {
  for (;;) {
    const Constructor& constructor = constructors()[size_t(r.below(own_constructors))];
    if (!can_be_random(constructor) || is_dear(constructor)) continue;
    if (may_be_left_out(r, constructor)) continue;
    if (takes_fields(constructor) != (depth > 0)) continue;
    return random_field(r, constructor, depth);
  }
}

}  // namespace sardf::laws
