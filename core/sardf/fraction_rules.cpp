#include "sardf/fraction_rules.hpp"

#include <algorithm>
#include <cmath>

#include "sardf/arithmetic.hpp"
#include "sardf/error.hpp"
#include "sardf/inverse_shares.hpp"
#include "sardf/short_number.hpp"

namespace sardf {

namespace {

size_t place_of(const std::string& material, const std::vector<std::string>& materials) {
  const auto found = std::find(materials.begin(), materials.end(), material);
  if (found == materials.end()) {
    throw Error("there is no material '" + material + "'" + did_you_mean(material, materials));
  }
  return size_t(found - materials.begin());
}

Expression sum(const std::vector<Expression>& terms) {
  Expression total = constant(0);
  for (const Expression& term : terms) total = total + term;
  return total;
}

Expression clamp01(const Expression& a) { return function("clamp", {a, constant(0), constant(1)}); }

// An influence must be positive; float still takes the logarithm of this.
constexpr double least_influence = 1e-30;
// Keeps differences of exponents free of inf - inf.
constexpr double largest_exponent = 1e30;
// A distance beyond this counts as this: float has no larger one that is finite.
constexpr double largest_distance = 1e37;

bool is_call_of(const Expression& e, const char* name) {
  return e->type == Node::Type::operation && e->operation->info().name == name;
}

Expression logarithm(const Expression& e);

// A sum so deep is taken as it is.
constexpr int deepest_sum = 8;

// The positive terms of a sum that has exponentials, each a number, an exponential or a multiple of
// one; false where it is none.
bool collect_terms(const Expression& e, std::vector<Expression>& terms, int depth = 0) {
  if (is_call_of(e, "add") && depth < deepest_sum) {
    return collect_terms(e->inputs[0], terms, depth + 1) &&
           collect_terms(e->inputs[1], terms, depth + 1);
  }
  const auto is_positive = [](const Expression& a) { return is_constant(a) && a->value > 0; };
  terms.push_back(e);
  return is_positive(e) || is_call_of(e, "exp") ||
         (is_call_of(e, "multiply") &&
          ((is_positive(e->inputs[0]) && is_call_of(e->inputs[1], "exp")) ||
           (is_positive(e->inputs[1]) && is_call_of(e->inputs[0], "exp"))));
}

// ln Σ exp(a_i) = m + ln Σ exp(a_i - m), m the largest.
Expression logarithm_of_sum(const std::vector<Expression>& terms) {
  std::vector<Expression> logarithms;
  for (const Expression& term : terms) logarithms.push_back(logarithm(term));
  Expression largest = logarithms[0];
  for (const Expression& a : logarithms) largest = max(largest, a);
  Expression total = constant(0);
  for (const Expression& a : logarithms) total = total + exp(a - largest);
  return largest + log(total);
}

// ln e without computing an exponential that could overflow: ln exp(a) = a, also as a factor and in
// a sum.
Expression logarithm(const Expression& e) {
  const auto plain = [](const Expression& a) { return log(max(a, constant(least_influence))); };
  if (is_constant(e)) return plain(e);
  std::vector<Expression> terms;
  if (is_call_of(e, "add") && collect_terms(e, terms)) return logarithm_of_sum(terms);
  if (is_call_of(e, "exp")) return e->inputs[0];
  const bool product = is_call_of(e, "multiply");
  if (product && is_call_of(e->inputs[0], "exp")) {
    return e->inputs[0]->inputs[0] + plain(e->inputs[1]);
  }
  if (product && is_call_of(e->inputs[1], "exp")) {
    return plain(e->inputs[0]) + e->inputs[1]->inputs[0];
  }
  if (is_call_of(e, "divide") && is_call_of(e->inputs[1], "exp")) {
    return plain(e->inputs[0]) - e->inputs[1]->inputs[0];
  }
  return plain(e);
}

// exp(a_i - max a) / Σ.
std::vector<Expression> normalized_exponentials(const std::vector<Expression>& a) {
  Expression largest = a[0];
  for (const Expression& e : a) largest = max(largest, e);
  std::vector<Expression> shares;
  for (const Expression& e : a) shares.push_back(exp(e - largest));
  const Expression total = sum(shares);
  for (Expression& share : shares) share = share / total;
  return shares;
}

}  // namespace

void ConstantFractions::check() const {
  double total = 0;
  for (const auto& [material, share] : shares) {
    if (!(share >= 0 && share <= 1 + 1e-6)) {
      throw Error("the share of '" + material + "' is " + short_number(share, 6) +
                  "; a number from 0 to 1 is accepted");
    }
    total += share;
  }
  if (std::abs(total - 1) > 1e-6) {
    throw Error("the shares sum to " + short_number(total, 6) + "; they must sum to 1");
  }
}

std::vector<Expression> ConstantFractions::values(const Lowering& lowering) const {
  double total = 0;
  for (const auto& [material, share] : shares) total += share;
  std::vector<Expression> out(lowering.materials.size(), constant(0));
  for (const auto& [material, share] : shares) {
    out[place_of(material, lowering.materials)] = constant(share / total);
  }
  return out;
}

std::vector<Expression> Formulas::values(const Lowering& lowering) const {
  std::vector<Expression> out(lowering.materials.size(), constant(0));
  std::vector<Expression> shares;
  for (const auto& [material, field] : functions) {
    // The field stands first: max(NaN, 0) is 0.
    shares.push_back(max(field.expression(), constant(0)));
  }
  // Where the sum is 0 so are all fractions, which whoever samples them reports.
  const Expression total = max(sum(shares), constant(1e-30));
  for (size_t i = 0; i < functions.size(); ++i) {
    Expression& to = out[place_of(functions[i].first, lowering.materials)];
    to = to + shares[i] / total;
  }
  return out;
}

void FractionFunctions::check() const {
  int rests = 0;
  for (const auto& [material, field] : functions.functions) rests += !field;
  if (rests > 1) {
    throw Error(std::to_string(rests) + " materials take the rest; only one can");
  }
}

// Their sum is 1, so that of their positive parts is at least 1.
std::vector<Expression> FractionFunctions::values(const Lowering& lowering) const {
  std::vector<Expression> shares;
  Expression given = constant(0);
  for (const auto& [material, field] : functions.functions) {
    if (field) given = given + field.expression();
  }
  for (const auto& [material, field] : functions.functions) {
    const Expression share = field ? field.expression() : constant(1) - given;
    shares.push_back(function("clamp", {share, constant(0), constant(1e30)}));
  }
  const Expression total = max(sum(shares), constant(1e-30));
  std::vector<Expression> out(lowering.materials.size(), constant(0));
  for (size_t i = 0; i < shares.size(); ++i) {
    out[place_of(functions.functions[i].first, lowering.materials)] = shares[i] / total;
  }
  return out;
}

std::vector<Expression> AttributeValue::values(const Lowering& lowering) const {
  if (components.size() != lowering.components) {
    throw Error("the value has " + std::to_string(components.size()) + " components where " +
                std::to_string(lowering.components) + " are needed");
  }
  if (!lowering.names.empty()) {
    throw Error("the value has no names for its components where others have");
  }
  std::vector<Expression> out;
  for (const Field& f : components) out.push_back(f.expression());
  return out;
}

std::vector<Expression> NamedComponents::values(const Lowering& lowering) const {
  const MaterialFunctions& named = components.functions;
  if (named.size() != lowering.names.size()) {
    throw Error("the value has " + std::to_string(named.size()) + " named components where " +
                std::to_string(lowering.names.size()) + " are needed");
  }
  std::vector<Expression> out;
  for (const std::string& wanted : lowering.names) {
    const auto found = std::find_if(named.begin(), named.end(),
                                    [&](const auto& pair) { return pair.first == wanted; });
    if (found == named.end()) throw Error("the value has no component '" + wanted + "'");
    out.push_back(found->second.expression());
  }
  return out;
}

std::vector<Expression> OfMaterials::values(const Lowering& lowering) const {
  if (lowering.components != 1) throw Error("of_materials gives one component only");
  Expression total = constant(0);
  for (const auto& [material, field] : functions) {
    const size_t place = place_of(material, lowering.materials);
    total = total + lowering.fractions.at(place) * field.expression();
  }
  return {total};
}

namespace {

// The shares of features without influences and with one exponent that inverse_shares takes; empty
// for others.
std::vector<Expression> plain_shares(const std::vector<InverseDistance::Feature>& features,
                                     double least) {
  std::vector<Expression> distances;
  for (const auto& feature : features) {
    if (feature.influence.field || feature.exponent != features[0].exponent) return {};
    distances.push_back(feature_distance(feature.at.field));
  }
  return inverse_shares(distances, features[0].exponent, least);
}

}  // namespace

std::vector<WeightedPart> InverseDistance::parts(double diagonal) const {
  if (features.size() == 1) return {{constant(1), features[0].fractions}};
  const std::vector<Expression> shares = plain_shares(features, on_feature * diagonal);
  if (!shares.empty()) {
    std::vector<WeightedPart> all;
    for (size_t i = 0; i < features.size(); ++i) all.push_back({shares[i], features[i].fractions});
    return all;
  }
  const Expression least = constant(on_feature * diagonal);
  std::vector<Expression> exponents, on;
  for (const Feature& feature : features) {
    const Expression u = feature_distance(feature.at.field);
    Expression a = log(function("clamp", {u, least, constant(largest_distance)}));
    if (feature.influence.field) a = a + logarithm(feature.influence.field.expression());
    a = constant(-feature.exponent) * a;
    // Without an influence |ln u| is less than 1000.
    if (feature.influence.field || feature.exponent > largest_exponent / 1000) {
      a = function("clamp", {a, constant(-largest_exponent), constant(largest_exponent)});
    }
    exponents.push_back(a);
    on.push_back(less_equal(u, least));
  }
  const std::vector<Expression> away = normalized_exponentials(exponents);
  const Expression touched = sum(on), shared = max(touched, constant(1));
  std::vector<WeightedPart> all;
  for (size_t i = 0; i < features.size(); ++i) {
    all.push_back({select(touched, on[i] / shared, away[i]), features[i].fractions});
  }
  return all;
}

void BlendBetween::check() const {
  if (of.size() != 2) {
    throw Error("of has " + std::to_string(of.size()) + " elements; exactly 2 are accepted");
  }
}

std::vector<WeightedPart> BlendBetween::parts(double diagonal) const {
  const Expression d0 = feature_distance(of[0].at.field), d1 = feature_distance(of[1].at.field);
  const Expression least = constant(on_feature * diagonal), both = d0 + d1;
  const Expression share = clamp01(d1 / max(both, least));
  const Expression first = select(less_equal(both, least), constant(0.5), share);
  return {{first, of[0].fractions}, {constant(1) - first, of[1].fractions}};
}

void Ramp::check() const {
  for (size_t i = 1; i < stops.size(); ++i) {
    if (stops[i].at < stops[i - 1].at) {
      throw Error("stop " + std::to_string(i + 1) + " is at " + short_number(stops[i].at, 6) +
                  ", before the one at " + short_number(stops[i - 1].at, 6) +
                  "; stops must be in rising order");
    }
  }
}

std::vector<WeightedPart> Ramp::parts(double) const {
  const Expression& t = field.expression();
  std::vector<WeightedPart> all;
  Expression reached = constant(1);  // 0 before a stop's predecessor, 1 from the stop on
  for (size_t i = 0; i < stops.size(); ++i) {
    Expression next = constant(0);
    if (i + 1 < stops.size()) {
      const double from = stops[i].at, to = stops[i + 1].at;
      next = from == to ? less_equal(constant(to), t)
                        : clamp01((t - constant(from)) / constant(to - from));
    }
    // The difference may round below 0 in float.
    all.push_back({max(constant(0), reached - next), stops[i].fractions});
    reached = next;
  }
  return all;
}

void Bands::check() const {
  for (const Band& band : bands) {
    if (blend_width > band.width) {
      throw Error("blend_width is " + short_number(blend_width, 6) +
                  ", more than the width of a stripe, " + short_number(band.width, 6));
    }
  }
}

std::vector<WeightedPart> Bands::parts(double) const {
  double period = 0;
  for (const Band& band : bands) period += band.width;
  const Expression along =
      function("mod", {field.expression() - constant(start), constant(period)});
  // 1 where the border at `value` has been passed.
  const auto passed = [&](double value) {
    if (blend_width == 0) return less_equal(constant(value), along);
    return clamp01((along - constant(value)) / constant(blend_width) + constant(0.5));
  };
  const bool sharp = blend_width == 0;
  const Expression begun = sharp ? constant(1) : passed(0);
  Expression before = begun;
  double border = 0;
  std::vector<WeightedPart> all;
  for (size_t i = 0; i < bands.size(); ++i) {
    border += bands[i].width;
    const bool last = i + 1 == bands.size();
    const Expression after = last && sharp ? constant(0) : passed(border);
    all.push_back({max(constant(0), before - after), bands[i].fractions});
    before = after;
  }
  if (sharp) return all;
  // The border between the last stripe and the first lies at both ends of the period.
  all.back().weight = all.back().weight + (constant(1) - begun);
  all.front().weight = all.front().weight + before;
  return all;
}

namespace {

// The place of the largest of the fields, the first of equals.
Expression place_of_largest(const std::vector<Partition::Part>& of) {
  Expression largest = of[0].solid.expression(), place = constant(0);
  for (size_t i = 1; i < of.size(); ++i) {
    const Expression& f = of[i].solid.expression();
    place = select(less(largest, f), constant(double(i)), place);
    largest = max(largest, f);
  }
  return place;
}

// How far each part counts at a point that it contains, or, with a width, is near to.
std::vector<Expression> presence(const Partition& partition, const Expression& tolerance) {
  std::vector<Expression> in;
  for (const Partition::Part& part : partition.of) {
    const Expression& f = part.solid.expression();
    in.push_back(partition.blend_width == 0
                     ? less_equal(-tolerance, f)
                     : clamp01(constant(1) + (f + tolerance) / constant(partition.blend_width)));
  }
  return in;
}

// What each part takes of what those with precedence leave over.
std::vector<Expression> in_turn(const std::vector<Expression>& in, bool from_last) {
  std::vector<Expression> taken(in.size());
  Expression left = constant(1);
  for (size_t k = 0; k < in.size(); ++k) {
    const size_t i = from_last ? in.size() - 1 - k : k;
    taken[i] = left * in[i];
    left = left * (constant(1) - in[i]);
  }
  return taken;
}

// 1 for the part with the largest field, falling to 0 for one that is smaller by the width.
std::vector<Expression> by_depth(const Partition& partition) {
  Expression largest = partition.of[0].solid.expression();
  for (const Partition::Part& part : partition.of) largest = max(largest, part.solid.expression());
  std::vector<Expression> shares;
  for (const Partition::Part& part : partition.of) {
    shares.push_back(clamp01(constant(1) + (part.solid.expression() - largest) /
                                               constant(partition.blend_width)));
  }
  return shares;
}

}  // namespace

void Partition::check() const {
  const std::vector<std::string> rules{"first", "last", "mean", "max"};
  if (std::find(rules.begin(), rules.end(), conflict) == rules.end()) {
    throw Error("conflict is '" + conflict + "'; accepted are 'first', 'last', 'mean' and 'max'" +
                did_you_mean(conflict, rules));
  }
}

std::vector<WeightedPart> Partition::parts(double diagonal) const {
  const Expression nearest = place_of_largest(of);
  const auto alone = [&](size_t i) { return function("equal", {nearest, constant(double(i))}); };
  std::vector<WeightedPart> all;
  if (conflict == "max" && blend_width == 0) {
    for (size_t i = 0; i < of.size(); ++i) all.push_back({alone(i), of[i].fractions});
    return all;
  }
  const std::vector<Expression> in = presence(*this, constant(in_region * diagonal));
  const std::vector<Expression> weights = conflict == "max"    ? by_depth(*this)
                                          : conflict == "mean" ? in
                                                               : in_turn(in, conflict == "last");
  // What is left over goes to all in proportion; where there is nothing, the nearest counts.
  const Expression total = sum(weights);
  for (size_t i = 0; i < of.size(); ++i) {
    const Expression share = weights[i] / max(total, constant(1e-30));
    all.push_back({select(less(constant(1e-30), total), share, alone(i)), of[i].fractions});
  }
  return all;
}

}  // namespace sardf
