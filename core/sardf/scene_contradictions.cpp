#include <algorithm>
#include <cmath>
#include <optional>

#include "sardf/arithmetic.hpp"
#include "sardf/box_search.hpp"
#include "sardf/scene_checks.hpp"
#include "sardf/short_number.hpp"

namespace sardf {

namespace {

// Of the diagonal: features this near to each other touch.
constexpr double touching = 1e-9;
constexpr int most_boxes = 4000;
constexpr int most_descents = 150;
constexpr int most_steps = 60;
// After some steps a descent that still gains less than this is given up.
constexpr int steps_of_grace = 4;
constexpr double least_gain = 0.98;
// Of the larger of 1 and the values: a difference up to this is none.
constexpr double same_value = 1e-6;

struct FeaturesOfRule {
  std::vector<Expression> distances;
  std::vector<std::vector<Expression>> values;  // what each prescribes
};

std::optional<FeaturesOfRule> features_of(const Rule& rule, const Lowering& lowering) {
  FeaturesOfRule all;
  for (size_t i = 0; i < rule.type->parameters.size(); ++i) {
    const std::vector<RuleParameter>& record = rule.type->parameters[i].record;
    const auto at = [&](RuleParameterType type) {
      return size_t(std::find_if(record.begin(), record.end(),
                                 [&](const RuleParameter& p) { return p.type == type; }) -
                    record.begin());
    };
    const size_t feature = at(RuleParameterType::feature);
    const size_t part = at(RuleParameterType::fractions);
    if (feature == record.size() || part == record.size()) continue;
    for (const Record& one : std::get<std::vector<Record>>(rule.arguments[i])) {
      all.distances.push_back(feature_distance(std::get<Field>(one.values[feature])));
      all.values.push_back(lower(std::get<Fractions>(one.values[part]), lowering));
    }
  }
  return all.distances.size() < 2 ? std::nullopt : std::optional(all);
}

// Whether the values are the same expressions, or numbers that hardly differ.
bool agree(const std::vector<Expression>& a, const std::vector<Expression>& b) {
  for (size_t i = 0; i < a.size(); ++i) {
    if (a[i] == b[i]) continue;
    if (!is_constant(a[i]) || !is_constant(b[i])) return false;
    const double size = std::max({1.0, std::abs(a[i]->value), std::abs(b[i]->value)});
    if (std::abs(a[i]->value - b[i]->value) > same_value * size) return false;
  }
  return true;
}

bool differ(const std::vector<double>& a, const std::vector<double>& b) {
  for (size_t i = 0; i < a.size(); ++i) {
    const double size = std::max({1.0, std::abs(a[i]), std::abs(b[i])});
    if (std::abs(a[i] - b[i]) > same_value * size) return true;
  }
  return false;
}

class Search {
 public:
  Search(const FeaturesOfRule& features, const Expression& share, const CheckedPlace& place)
      : place_(place), n_(features.distances.size()), diagonal_(place.box.diagonal()) {
    for (size_t i = 0; i < n_; ++i) {
      distances_.emplace_back(features.distances[i]);
      values_.emplace_back(features.values[i]);
      for (size_t j = i + 1; j < n_; ++j) {
        if (!agree(features.values[i], features.values[j])) pairs_.push_back({i, j});
      }
    }
    std::vector<Expression> outputs{place.solid, share};
    inside_ = Evaluator(outputs);
    outputs.insert(outputs.end(), features.distances.begin(), features.distances.end());
    for (const auto& values : features.values) {
      outputs.insert(outputs.end(), values.begin(), values.end());
    }
    channels_ = features.values[0].size();
    all_ = Evaluator(outputs);
  }

  std::vector<Contradiction> run(const Progress& progress) {
    search_boxes(place_.box, most_boxes, progress, [&](const BoundingBox& box, bool descends) {
      const std::vector<Pair> near = possible_in(box);
      for (size_t i = 0; descends && i < near.size(); ++i) descend(near[i], box.center());
      return !near.empty();
    });
    return std::move(found_);
  }

 private:
  struct Pair {
    size_t first, second;
    friend bool operator==(const Pair&, const Pair&) = default;
  };

  std::vector<Pair> possible_in(const BoundingBox& box) const {
    if (pairs_.empty()) return {};
    std::vector<Interval> out(2 + n_ * (1 + channels_));
    all_.intervals(box, out.data());
    if (out[0].hi < -place_.tolerance || out[1].hi <= 0) return {};
    const auto may_differ = [&](const Pair& pair) {
      for (size_t c = 0; c < channels_; ++c) {
        const Interval a = out[2 + n_ + pair.first * channels_ + c];
        const Interval b = out[2 + n_ + pair.second * channels_ + c];
        if (!((a - b).magnitude() <= same_value)) return true;
      }
      return false;
    };
    const auto may_be_on = [&](size_t i) { return !(out[2 + i].lo > touching * diagonal_); };
    std::vector<Pair> near;
    for (const Pair& pair : pairs_) {
      if (may_be_on(pair.first) && may_be_on(pair.second) && may_differ(pair)) {
        near.push_back(pair);
      }
    }
    return near;
  }

  // Towards a point on both features: Newton's step for both, or towards one after the other where
  // that does not bring them nearer.
  std::optional<Vec3> touch_near(const Pair& pair, Vec3 point) const {
    const Evaluator &first = distances_[pair.first], &second = distances_[pair.second];
    ValueAndGradient a = value_and_gradient(first, point), b = value_and_gradient(second, point);
    for (int step = 0; step < most_steps; ++step) {
      if (!(std::max(a.value, b.value) > touching * diagonal_)) return point;
      Vec3 by = common_newton_step(a, b);
      const double longest = 0.25 * diagonal_, length = norm(by);
      if (!(length < infinity)) return std::nullopt;
      if (length > longest) by = longest / length * by;
      Vec3 next = point + by;
      ValueAndGradient c = value_and_gradient(first, next), d = value_and_gradient(second, next);
      if (!(c.value + d.value < 0.9 * (a.value + b.value))) {
        next = point - a.value * a.gradient;
        const ValueAndGradient then = value_and_gradient(second, next);
        next = next - then.value * then.gradient;
        c = value_and_gradient(first, next);
        d = value_and_gradient(second, next);
      }
      if (step >= steps_of_grace && !(c.value + d.value < least_gain * (a.value + b.value))) {
        return std::nullopt;
      }
      point = next;
      a = c;
      b = d;
    }
    return std::nullopt;
  }

  void descend(const Pair& pair, const Vec3& from) {
    if (std::find(pairs_.begin(), pairs_.end(), pair) == pairs_.end()) return;
    if (descents_++ >= most_descents) return;
    const std::optional<Vec3> point = touch_near(pair, from);
    if (!point) return;
    for (size_t axis = 0; axis < 3; ++axis) {
      const double at = (*point)[axis];
      if (!(place_.box.lo[axis] <= at && at <= place_.box.hi[axis])) return;
    }
    double solid_and_share[2];
    inside_.values(*point, solid_and_share);
    if (!(solid_and_share[0] >= -place_.tolerance && solid_and_share[1] > 1e-9)) return;
    Contradiction found;
    found.point = *point;
    found.first = pair.first;
    found.second = pair.second;
    found.first_values.resize(channels_);
    found.second_values.resize(channels_);
    values_[pair.first].values(*point, found.first_values.data());
    values_[pair.second].values(*point, found.second_values.data());
    if (!differ(found.first_values, found.second_values)) return;
    // What is left of a descent to 0.
    for (double& a : found.point) a = std::abs(a) < 10 * touching * diagonal_ ? 0 : a;
    found_.push_back(std::move(found));
    std::erase(pairs_, pair);
  }

  const CheckedPlace& place_;
  size_t n_, channels_ = 0;
  double diagonal_;
  std::vector<Evaluator> distances_, values_;
  Evaluator inside_, all_;
  std::vector<Pair> pairs_;
  int descents_ = 0;
  std::vector<Contradiction> found_;
};

FeaturesOfRule joined(const CheckedPlace& place, FeaturesOfRule features) {
  if (!place.blend) return features;
  features.distances = joined_by(*place.blend, features.distances);
  for (auto& values : features.values) values = joined_by(*place.blend, values);
  return features;
}

std::string list_of(const std::vector<double>& values, const std::vector<std::string>& names) {
  std::string text;
  for (size_t i = 0; i < values.size(); ++i) {
    text += (i ? ", " : "") + (i < names.size() ? names[i] + " " : "") + short_number(values[i], 4);
  }
  return text;
}

}  // namespace

std::vector<Contradiction> find_contradictions(const CheckedRule& checked,
                                               const CheckedPlace& place,
                                               const Progress& progress) {
  std::vector<Contradiction> all;
  for (const PlacedRule& placed : placed_rules(checked.rule, checked.lowering.diagonal)) {
    const auto features = features_of(placed.rule.rule(), checked.lowering);
    if (!features) continue;
    Expression share = placed.share;
    if (place.blend) share = joined_by(*place.blend, share);
    for (Contradiction& found : Search(joined(place, *features), share, place).run(progress)) {
      found.owner = checked.owner;
      all.push_back(std::move(found));
    }
  }
  return all;
}

Warning warning_of(const Contradiction& found, const std::vector<std::string>& names) {
  return {found.owner + ": features " + std::to_string(found.first + 1) + " and " +
          std::to_string(found.second + 1) + " touch at " + short_point(found.point.data(), 4) +
          ", where they prescribe different values (" + list_of(found.first_values, names) +
          " and " + list_of(found.second_values, names) + "); their mean counts there"};
}

}  // namespace sardf
