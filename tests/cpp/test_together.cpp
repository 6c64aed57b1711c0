// Instructions that one call evaluates: which they are, and that results stay the same bits.
#include <gtest/gtest.h>

#include <bit>
#include <random>

#include "sardf/arithmetic.hpp"
#include "sardf/constructor.hpp"
#include "sardf/evaluate.hpp"
#include "sardf/fractions.hpp"
#include "sardf/inverse_shares.hpp"
#include "sardf/scene_file.hpp"
#include "sardf/shorten.hpp"
#include "source_folder.hpp"

namespace sardf {
namespace {

const Expression x = coordinate(0), y = coordinate(1), z = coordinate(2);

using Numbers = std::vector<uint32_t>;

/// How many instructions run together, in the order of the program, where these are several.
Numbers together(const Tape& tape) {
  Numbers counts;
  for (size_t i = 0; i < tape.instructions().size(); i += tape.instructions()[i].together) {
    const uint32_t count = tape.instructions()[i].together;
    if (count > 1) counts.push_back(count);
  }
  return counts;
}
Numbers together(const std::vector<Expression>& outputs) { return together(Tape(outputs)); }

std::vector<Expression> distances(size_t n) {
  std::vector<Expression> u{abs(x), abs(y), abs(z), abs(x - y)};
  u.resize(n);
  return u;
}

std::vector<Expression> shares(size_t n, double exponent = 1) {
  return inverse_shares(distances(n), exponent, 1e-12);
}

std::vector<Expression> colour(const std::vector<Expression>& fractions) {
  std::vector<Expression> channels;
  for (const double first : {0.25, 0.5, 0.75}) {
    std::vector<double> factors;
    for (size_t m = 0; m < fractions.size(); ++m) factors.push_back(first / double(m + 1));
    channels.push_back(weighted_sum(fractions, factors));
  }
  return channels;
}

std::vector<Expression> joined(std::vector<Expression> a, const std::vector<Expression>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

TEST(Together, AreSharesOfTheSameDistancesAndSumsOfTheSameValues) {
  for (const size_t n : {2u, 3u, 4u}) {
    const std::vector<Expression> fractions = shares(n);
    EXPECT_EQ(together(fractions), Numbers{uint32_t(n)});
    EXPECT_EQ(together(colour(fractions)), (Numbers{uint32_t(n), 3})) << n;
    EXPECT_EQ(together(joined({x * y}, joined(fractions, colour(fractions)))),
              (Numbers{uint32_t(n), 3}))
        << n;
  }
}

TEST(Together, InWhateverOrderTheyAreAskedFor) {
  const std::vector<Expression> u = shares(3), rgb = colour(u);
  const std::vector<Expression> outputs{u[2] * x, rgb[1], u[1] + y, rgb[2] * u[0], u[0], rgb[0]};
  EXPECT_EQ(together(outputs), (Numbers{3, 3}));
}

TEST(Together, AreNotThoseOfOtherInputsOrParameters) {
  const std::vector<Expression> u = shares(3), squared = shares(3, 3);
  const std::vector<Expression> of_more = inverse_shares(distances(3), 1, 1e-6);
  std::vector<Expression> turned_distances = distances(3);
  std::swap(turned_distances[0], turned_distances[1]);
  const std::vector<Expression> turned = inverse_shares(turned_distances, 1, 1e-12);
  EXPECT_EQ(together({u[0], u[1]}), Numbers{});
  EXPECT_EQ(together({u[0], u[1], squared[2]}), Numbers{});
  EXPECT_EQ(together({u[0], u[1], of_more[2]}), Numbers{});
  EXPECT_EQ(together({u[0], u[1], turned[2]}), Numbers{});
  EXPECT_EQ(together(joined(u, joined(squared, joined(of_more, turned)))), (Numbers{3, 3, 3, 3}));
  const std::vector<Expression> rgb = colour({x, y, z}), other = colour({x, y, z * z});
  EXPECT_EQ(together({rgb[0], rgb[1]}), Numbers{});
  EXPECT_EQ(together({rgb[0], rgb[1], other[2]}), Numbers{});
  EXPECT_EQ(together(rgb), Numbers{3});
}

/// Of n materials by the distances to a point each.
std::vector<Expression> fractions_of_points(size_t n, double exponent) {
  const std::vector<std::string> materials{"a", "b", "c", "d"};
  std::vector<Record> features;
  for (size_t m = 0; m < n; ++m) {
    const Field at = make_field("point", {Vec3{double(m), 1, -double(m * m)}});
    features.push_back({{at, Fractions::material(materials[m]), exponent, RuleValue()}});
  }
  const std::vector<std::string> used(materials.begin(), materials.begin() + long(n));
  return lower(make_fractions("inverse_distance", {features}), used, 10);
}

TEST(Together, AreFractionsAndColoursByRules) {
  for (const double exponent : {1.0, 2.0, 2.5}) {
    for (const size_t n : {2u, 3u, 4u}) {
      const std::vector<Expression> fractions = fractions_of_points(n, exponent);
      const Numbers expected{uint32_t(n), 3};
      EXPECT_EQ(together(colour(fractions)), expected) << n;
      EXPECT_EQ(together(joined({x * y}, joined(fractions, colour(fractions)))), expected) << n;
    }
  }
}

TEST(Together, AreFractionsAndColoursOfScenes) {
  const auto counts = [](const char* name) {
    const Scene scene(read_scene(source_folder() / "scenes" / name));
    const auto color = scene.base_color();
    const std::vector<Expression> channels(color.begin(), color.end());
    return std::pair(together(channels),
                     together(joined({scene.solid()}, joined(scene.fractions(), channels))));
  };
  EXPECT_EQ(counts("two_ellipsoids.json"), std::pair(Numbers({2, 3}), Numbers({2, 3})));
  // Influences are taken by logarithms, ramps and partitions are no shares.
  for (const char* name : {"three_materials.json", "tooth_stripes.json", "cad_plate.json"}) {
    EXPECT_EQ(counts(name), std::pair(Numbers({3}), Numbers({3}))) << name;
  }
}

TEST(Together, OfShortenedProgramsAreFoundAgain) {
  // x < 9 goes.
  const Evaluator whole(joined({max(x, y + constant(9))}, joined(shares(3), colour(shares(3)))));
  const Evaluator shorter = Shortening(whole, {{-1, -1, -1}, {1, 1, 1}}).shortened();
  EXPECT_LT(shorter.tape().instructions().size(), whole.tape().instructions().size());
  EXPECT_EQ(together(shorter.tape()), (Numbers{3, 3}));
}

/// On features, equally far from some, and where products or floats end.
std::vector<float> points(size_t n) {
  const float infinite = std::numeric_limits<float>::infinity();
  const std::vector<float> special{0,      -0.f,  1,     1,     2,        1e-45f,
                                   1e-13f, 1e-7f, 1e12f, 3e38f, infinite, std::nanf("")};
  std::mt19937 random(11);
  std::uniform_real_distribution<float> ordinary(-4, 4);
  std::vector<float> all;
  for (size_t i = 0; i < 3 * n; ++i) {
    all.push_back(i < 3 * n / 2 ? ordinary(random) : special[random() % special.size()]);
  }
  return all;
}

bool same(float a, float b) {
  return std::bit_cast<uint32_t>(a) == std::bit_cast<uint32_t>(b) ||
         (std::isnan(a) && std::isnan(b));
}

TEST(Together, GiveTheBitsOfEachAlone) {
  // Not a whole number of blocks: the last one is copied from scratch, others are written in place.
  constexpr size_t n = 5000;
  const std::vector<float> at = points(n);
  for (const size_t count : {2u, 3u, 4u}) {
    for (const double exponent : {1.0, 1.5, 2.0, 2.5, 3.0}) {
      const std::vector<Expression> fractions = shares(count, exponent);
      if (fractions.empty()) continue;
      const std::vector<Expression> all = joined(fractions, colour(fractions));
      ASSERT_EQ(together(all), (Numbers{uint32_t(count), 3}));
      std::vector<float> values(n * all.size()), alone(n);
      Evaluator(all).values(at.data(), n, values.data());
      for (size_t k = 0; k < all.size(); ++k) {
        const Evaluator evaluator(all[k]);
        if (k < count) {
          ASSERT_EQ(together(evaluator.tape()), Numbers{});
        }
        evaluator.values(at.data(), n, alone.data());
        for (size_t i = 0; i < n; ++i) {
          EXPECT_TRUE(same(values[i * all.size() + k], alone[i]))
              << count << ' ' << exponent << ' ' << k << ": " << values[i * all.size() + k]
              << ", alone " << alone[i] << " at " << at[3 * i] << ' ' << at[3 * i + 1];
        }
      }
    }
  }
}

}  // namespace
}  // namespace sardf
