// Where the golden values of helices are not the nearest's.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "golden.hpp"
#include "sardf/vec.hpp"

namespace sardf::golden {

/// A helix around the z axis of its center, two turns long, with the search for the nearest point
/// that made the golden values: it tries 721 places, and looks no further than the next to the best
/// of them. Between two turns that are nearly as far it may choose the other one.
struct HelixSearch {
  Vec3 center{};
  double radius = 0, pitch = 0;

  bool misses_the_nearest(const Vec3& point) const {
    std::array<double, places> squares;
    for (int k = 0; k < places; ++k) squares[size_t(k)] = squared(point, angle(k));
    const auto best = std::min_element(squares.begin(), squares.end());
    const double found = local_minimum(point, int(best - squares.begin()));
    double nearest = found;
    for (int k = 1; k + 1 < places; ++k) {
      const auto here = squares.begin() + k;
      if (here[0] <= here[-1] && here[0] <= here[1]) {
        nearest = std::min(nearest, local_minimum(point, k));
      }
    }
    return std::sqrt(found) > std::sqrt(nearest) + 1e-10;
  }

  /// Removes the rows that the search may have wrong: no more than a few.
  void remove_missed(Table& table) const {
    const size_t all = table.rows.size();
    std::erase_if(table.rows, [&](const std::vector<double>& row) {
      return misses_the_nearest(
          {row[table.column("x")], row[table.column("y")], row[table.column("z")]});
    });
    EXPECT_GT(table.rows.size(), 0.98 * double(all));
  }

 private:
  static constexpr int places = 721;
  static constexpr double end = 2 * std::numbers::pi, step = 2 * end / (places - 1);

  static double angle(int k) { return -end + step * k; }
  double squared(const Vec3& p, double t) const {
    const Vec3 on{radius * std::cos(t), radius * std::sin(t), pitch * t / end};
    return dot(p - center - on, p - center - on);
  }
  double local_minimum(const Vec3& point, int k) const {
    double lo = std::max(-end, angle(k - 1)), hi = std::min(end, angle(k + 1));
    for (int i = 0; i < 100; ++i) {
      const double left = lo + (hi - lo) / 3, right = hi - (hi - lo) / 3;
      const bool nearer_left = squared(point, left) < squared(point, right);
      (nearer_left ? hi : lo) = nearer_left ? right : left;
    }
    return squared(point, lo);
  }
};

}  // namespace sardf::golden
