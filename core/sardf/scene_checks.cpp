#include "sardf/scene_checks.hpp"

#include <algorithm>
#include <cmath>
#include <queue>

#include "sardf/arithmetic.hpp"
#include "sardf/error.hpp"
#include "sardf/fraction_rules.hpp"
#include "sardf/polynomial.hpp"
#include "sardf/short_number.hpp"

namespace sardf {

namespace {

// Fractions may leave [0, 1] by this.
constexpr double allowed = 1e-6;
constexpr double sum_error = 1e-9;
constexpr size_t samples_per_axis = 24;
constexpr int most_boxes = 3000;

void report(const Progress& progress, double share) {
  if (progress && !progress(share)) throw Cancelled();
}

std::vector<double> grid(const BoundingBox& box) {
  constexpr size_t n = samples_per_axis;
  std::vector<double> points;
  points.reserve(3 * n * n * n);
  for (size_t i = 0; i < n * n * n; ++i) {
    const size_t at[3] = {i % n, i / n % n, i / (n * n)};
    for (size_t axis = 0; axis < 3; ++axis) {
      const double share = (double(at[axis]) + 0.5) / double(n);
      points.push_back(box.lo[axis] + share * (box.hi[axis] - box.lo[axis]));
    }
  }
  return points;
}

// A rule `functions`: what each material's function is, and where errors are.
struct Functions {
  std::vector<std::string> materials;
  std::vector<Expression> all;
  std::string owner;
  RulePointer rule;
  const SceneSource& source;

  /// `blamed`: a material's place, or that of no one function.
  [[noreturn]] void fail(std::optional<size_t> blamed, const std::string& message) const {
    throw source.error_in(rule, blamed ? materials[*blamed] : "", owner + ": " + message);
  }
};

// The only function, or the only one that is no finite number at the point.
std::optional<size_t> to_blame(const Functions& functions, const double* point) {
  const size_t n = functions.all.size();
  if (n == 1) return 0;
  std::vector<double> values(n);
  Evaluator(functions.all).values(point, 1, values.data());
  std::optional<size_t> found;
  for (size_t i = 0; i < n; ++i) {
    if (std::isfinite(values[i])) continue;
    if (found) return std::nullopt;
    found = i;
  }
  return found;
}

// Throws unless the sum is proven to be 1.
void check_sum(const Functions& functions, const CheckedPlace& place) {
  Expression sum = constant(0);
  for (const Expression& e : functions.all) sum = sum + e;
  const std::optional<double> proven = proven_constant(sum);
  if (proven && std::abs(*proven - 1) <= 1e-12) return;
  const std::vector<double> points = grid(place.box);
  const size_t n = points.size() / 3;
  std::vector<double> values(n);
  Evaluator(sum).values(points.data(), n, values.data());
  size_t worst = 0;
  const auto off = [&](size_t i) {
    return std::isnan(values[i]) ? infinity : std::abs(values[i] - 1);
  };
  for (size_t i = 1; i < n; ++i) {
    if (off(i) > off(worst)) worst = i;
  }
  if (off(worst) > sum_error) {
    const double* p = &points[3 * worst];
    functions.fail(to_blame(functions, p), "the functions sum to " +
                                               short_number(values[worst], 9) + " at " +
                                               short_point(p) + "; they must sum to 1 everywhere");
  }
  functions.fail(
      std::nullopt,
      "that the functions sum to 1 cannot be proven; write the word \"rest\" in place of "
      "one, which is 1 minus the others");
}

// One function of a rule over the solid: proven bounds by halving the boxes with the worst ones.
class RangeProof {
 public:
  RangeProof(const Expression& function, const Expression& share, const CheckedPlace& place)
      : evaluator_(std::vector<Expression>{function, place.solid, share}),
        place_(place),
        least_(-place.tolerance) {}

  /// A point of the solid at which the function is not a fraction; nullopt where none was met.
  std::optional<std::pair<Vec3, double>> found() const { return found_; }
  /// Encloses the function in the solid.
  Interval proven() const { return proven_; }

  void run(const Progress& progress) {
    sample();
    add(place_.box);
    for (int used = 1; !open_.empty() && !found_ && used < most_boxes; ++used) {
      report(progress, double(used) / most_boxes);
      const BoundingBox box = open_.top().box;
      open_.pop();
      const Vec3 size = box.size();
      const size_t axis = size_t(std::max_element(size.begin(), size.end()) - size.begin());
      BoundingBox low = box, high = box;
      low.hi[axis] = high.lo[axis] = box.center()[axis];
      add(low);
      add(high);
    }
    for (; !open_.empty(); open_.pop()) proven_ = hull(proven_, open_.top().range);
  }

 private:
  struct Part {
    BoundingBox box;
    Interval range;
    double excess = 0;
    bool operator<(const Part& other) const { return excess < other.excess; }
  };

  static double excess_of(double lo, double hi) { return std::max(-lo, hi - 1); }

  void look_at(const Vec3& point, const double* values) {
    const double excess = excess_of(values[0], values[0]);
    if (values[1] >= 0 && values[2] > 1e-9 && !(excess <= allowed)) {
      if (!found_) found_ = {point, values[0]};
    }
  }

  void sample() {
    const std::vector<double> points = grid(place_.box);
    std::vector<double> values(points.size());
    evaluator_.values(points.data(), points.size() / 3, values.data());
    for (size_t i = 0; i < points.size(); i += 3) {
      look_at({points[i], points[i + 1], points[i + 2]}, &values[i]);
    }
  }

  void add(const BoundingBox& box) {
    Interval out[3];
    evaluator_.intervals(box, out);
    if (out[1].hi < least_ || out[2].hi <= 0) return;
    if (std::isnan(out[0].lo) || std::isnan(out[0].hi)) out[0] = Interval::all();
    const double excess = excess_of(out[0].lo, out[0].hi);
    if (excess <= allowed) return;
    double values[3];
    evaluator_.values(box.center(), values);
    look_at(box.center(), values);
    open_.push({box, out[0], excess});
  }

  Evaluator evaluator_;
  const CheckedPlace& place_;
  double least_;
  std::priority_queue<Part> open_;
  std::optional<std::pair<Vec3, double>> found_;
  Interval proven_{0, 1};
};

std::optional<Warning> check_range(const Functions& functions, size_t which,
                                   const Expression& share, const CheckedPlace& place,
                                   const Progress& progress) {
  const std::string named = "the function of '" + functions.materials[which] + "' is ";
  RangeProof proof(functions.all[which], share, place);
  proof.run(progress);
  if (const auto found = proof.found()) {
    functions.fail(which, named + short_number(found->second, 6) + " at " +
                              short_point(found->first.data()) +
                              ", in the solid; a fraction lies in [0, 1]");
  }
  const Interval proven = proof.proven();
  if (proven.lo >= 0 && proven.hi <= 1) return std::nullopt;
  return Warning{functions.owner + ": " + named +
                 "not proven to lie in [0, 1] in the solid, but only in [" +
                 short_number(proven.lo, 3) + ", " + short_number(proven.hi, 3) +
                 "]; where it does not, it is cut off"};
}

std::vector<Expression> joined(const CheckedPlace& place, const std::vector<Expression>& all) {
  return place.blend ? joined_by(*place.blend, all) : all;
}

// `share`: of the rule, joined as the scene says.
void check_one(const Fractions& rule, const Expression& share, const CheckedPlace& place,
               const std::string& owner, const SceneSource& source, const Progress& progress,
               std::vector<Warning>& warnings) {
  const auto& given = std::get<MaterialFunctions>(rule.rule().arguments[0]);
  Functions functions{{}, {}, owner, rule.pointer(), source};
  Expression sum = constant(0);
  bool has_rest = false;
  for (const auto& [material, field] : given) {
    has_rest = has_rest || !field;
    if (field) sum = sum + field.expression();
  }
  for (const auto& [material, field] : given) {
    functions.materials.push_back(material);
    functions.all.push_back(field ? field.expression() : constant(1) - sum);
  }
  functions.all = joined(place, functions.all);
  if (!has_rest) check_sum(functions, place);
  for (size_t i = 0; i < given.size(); ++i) {
    const auto warning = check_range(functions, i, share, place, progress);
    if (warning) warnings.push_back(*warning);
  }
}

bool has_features(const RuleType& type) {
  for (const RuleParameter& parameter : type.parameters) {
    for (const RuleParameter& inner : parameter.record) {
      if (inner.type == RuleParameterType::feature) return true;
    }
  }
  return false;
}

}  // namespace

std::vector<PlacedRule> placed_rules(const Fractions& rule, double diagonal) {
  std::vector<PlacedRule> all{{rule, constant(1)}};
  for (size_t i = 0; i < all.size(); ++i) {
    const PlacedRule outer = all[i];
    if (!outer.rule.rule().parts) continue;
    const bool everywhere = has_features(*outer.rule.rule().type);
    for (const WeightedPart& part : outer.rule.rule().parts(diagonal)) {
      all.push_back({part.of, everywhere ? outer.share : outer.share * part.weight});
    }
  }
  return all;
}

std::vector<Warning> check_functions(const CheckedRule& checked, const CheckedPlace& place,
                                     const SceneSource& source, const Progress& progress) {
  std::vector<Warning> warnings;
  if (!uses_rule(checked.rule, FractionFunctions::name)) return warnings;
  for (const PlacedRule& placed : placed_rules(checked.rule, checked.lowering.diagonal)) {
    if (placed.rule.rule().type->name != FractionFunctions::name) continue;
    check_one(placed.rule, joined(place, {placed.share})[0], place, checked.owner, source, progress,
              warnings);
  }
  return warnings;
}

}  // namespace sardf
