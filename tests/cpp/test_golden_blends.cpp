// Blends, their trees and the figures of the SARDF paper's section 5 against golden values.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "golden.hpp"
#include "sardf/certify.hpp"
#include "sardf/constructor.hpp"
#include "sardf/evaluate.hpp"

namespace sardf {
namespace {

using golden::Table;

enum class Join { intersection, unite, difference };

BlendPointer blend_of(const std::string& name, double radius) {
  return find_blend_type(name)->parameters.empty() ? make_blend(name, {})
                                                   : make_blend(name, {radius});
}

const OperationPointer& operation_of(const Blend& blend, Join join) {
  return join == Join::intersection ? blend.intersection
         : join == Join::unite      ? blend.unite
                                    : blend.difference;
}

/// The blend of the coordinates x and y.
Evaluator blend_of_coordinates(const std::string& blend, double radius, Join join) {
  return Evaluator(
      call(operation_of(*blend_of(blend, radius), join), {coordinate(0), coordinate(1)}));
}

struct Operation {
  const char* file;
  const char* blend;
  Join join;
};

class GoldenOperation : public golden::EachFolderWith<Operation> {
 protected:
  const Evaluator& evaluator(double radius) {
    const auto [at, added] = evaluators_.try_emplace(radius);
    if (added) at->second = blend_of_coordinates(this_case().blend, radius, this_case().join);
    return at->second;
  }
  Table table_ = read(std::string("op_") + this_case().file);

 private:
  std::map<double, Evaluator> evaluators_;
};

TEST_P(GoldenOperation, ValuesAndPartials) {
  size_t compared = 0;
  for (const std::vector<double>& row : table_.rows) {
    const double R = row[2], expected = row[3];
    const double point[3] = {row[0], row[1], 0};
    double value, gradient[3];
    evaluator(R).gradients(point, 1, &value, gradient);
    EXPECT_NEAR(value, expected, table_.tolerance()) << row[0] << ' ' << row[1] << ' ' << R;
    EXPECT_EQ(value, evaluator(R).value({row[0], row[1], 0}));
    // The gradient of `sardf` jumps across two arcs: on them either side is right.
    const double from_arc =
        std::min(std::abs(std::abs(expected) - R), std::abs(std::abs(expected) - 2 * R));
    const bool jumps = this_case().blend == std::string("sardf") && from_arc < 1e-9 * R;
    if (std::isnan(row[4]) || std::isnan(row[5]) || jumps) continue;
    ++compared;
    EXPECT_NEAR(gradient[0], row[4], table_.tolerance()) << row[0] << ' ' << row[1] << ' ' << R;
    EXPECT_NEAR(gradient[1], row[5], table_.tolerance()) << row[0] << ' ' << row[1] << ' ' << R;
  }
  EXPECT_GT(compared, table_.rows.size() * 9 / 10);
}

TEST_P(GoldenOperation, ValuesInFloat) {
  for (const std::vector<double>& row : table_.rows) {
    const float point[3] = {float(row[0]), float(row[1]), 0};
    float value;
    evaluator(row[2]).values(point, 1, &value);
    const double most = std::max({std::abs(row[0]), std::abs(row[1]), row[2]});
    EXPECT_NEAR(value, row[3], 2e-6 * most) << row[0] << ' ' << row[1] << ' ' << row[2];
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, GoldenOperation,
    testing::Combine(
        golden::each_folder(),
        testing::Values(Operation{"sardf_intersection", "sardf", Join::intersection},
                        Operation{"sardf_union", "sardf", Join::unite},
                        Operation{"sardf_subtraction", "sardf", Join::difference},
                        Operation{"sardf_arc_sides", "sardf", Join::intersection},
                        Operation{"sardf_c1_intersection", "sardf_c1", Join::intersection},
                        Operation{"sardf_c1_union", "sardf_c1", Join::unite},
                        Operation{"sardf_c1_subtraction", "sardf_c1", Join::difference},
                        Operation{"min", "min_max", Join::intersection},
                        Operation{"max", "min_max", Join::unite},
                        Operation{"r_intersection", "r_function", Join::intersection},
                        Operation{"r_union", "r_function", Join::unite},
                        Operation{"r_subtraction", "r_function", Join::difference})),
    [](const auto& of) {
      return golden::test_name(std::get<0>(of.param)) + "_" + std::get<1>(of.param).file;
    });

// The roots of both quartics and their derivatives with 60 digits, R = 1: near the ends of the arcs
// the roots are found last.
TEST(SardfC1, HasPartialsNearTheEndsOfItsArcs) {
  const double rows[][5] = {
      {-0.0428712, -0.000495836, -0.0428712155779425244, 0.999981268644915877,
       0.000857075410891899934},
      {-0.000271831, -4.33621e-08, -0.000271831001139509921, 0.999999983362921729,
       9.15670685513493294e-05},
      {-0.8, -0.3, -0.81406622570172138, 0.909634878432787453, 0.192623687117146336},
      {0.00801306, 1.60721e-05, 1.60707702558904761e-05, 0.00050404811836580164,
       0.874301832340744767},
      {0.0249, 0.000162, 0.000159470409792466307, 0.00670872495198903112, 0.472472640056539273},
      {0.8, 0.5, 0.3810656727072953, 0.318413995058827615, 0.538206737655262724}};
  const Evaluator evaluator = blend_of_coordinates("sardf_c1", 1, Join::intersection);
  for (const auto& row : rows) {
    const double point[3] = {row[0], row[1], 0};
    double value, gradient[3];
    evaluator.gradients(point, 1, &value, gradient);
    EXPECT_NEAR(value, row[2], 1e-15) << row[0];
    EXPECT_NEAR(gradient[0], row[3], 1e-12) << row[0];
    EXPECT_NEAR(gradient[1], row[4], 1e-12) << row[0];
  }
}

// Sums over the grid of the paper's Table 1.
using GoldenTable1 = golden::InEachFolder;

TEST_P(GoldenTable1, Checksums) {
  const Table table = read("sardf_table1_checksums");
  const double R = table.parameter("R");
  const std::vector<Evaluator> operations{blend_of_coordinates("sardf", R, Join::intersection),
                                          blend_of_coordinates("min_max", R, Join::intersection),
                                          blend_of_coordinates("r_function", R, Join::intersection),
                                          blend_of_coordinates("sardf", R, Join::unite),
                                          blend_of_coordinates("min_max", R, Join::unite),
                                          blend_of_coordinates("r_function", R, Join::unite)};
  constexpr size_t n = 1001;
  std::vector<double> points, values(n * n);
  for (size_t i = 0; i < n; ++i) {
    for (size_t j = 0; j < n; ++j) {
      points.insert(points.end(), {-10 + 0.02 * double(i), -10 + 0.02 * double(j), 0});
    }
  }
  ASSERT_EQ(table.rows.size(), operations.size());
  for (const std::vector<double>& row : table.rows) {
    operations[size_t(row[0])].values(points.data(), n * n, values.data());
    double sum = 0, magnitudes = 0;
    for (double value : values) {
      sum += value;
      magnitudes += std::abs(value);
    }
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    EXPECT_NEAR(sum, row[1], table.tolerance() * std::abs(row[1])) << row[0];
    EXPECT_NEAR(magnitudes, row[2], table.tolerance() * row[2]) << row[0];
    EXPECT_NEAR(*least, row[3], table.tolerance()) << row[0];
    EXPECT_NEAR(*most, row[4], table.tolerance()) << row[0];
  }
}

INSTANTIATE_TEST_SUITE_P(Each, GoldenTable1, golden::each_folder(), golden::folder_name);

// A tree of the file's header, over four values a, b, c, d: n-ary nodes fold from the left.
Expression tree_of(const nlohmann::json& tree, const Blend& blend,
                   const std::map<std::string, Expression>& leaves) {
  if (tree.is_string()) return leaves.at(tree.get<std::string>());
  const OperationPointer& join = tree[0] == "union" ? blend.unite : blend.intersection;
  Expression result = tree_of(tree[1], blend, leaves);
  for (size_t i = 2; i < tree.size(); ++i) {
    result = call(join, {result, tree_of(tree[i], blend, leaves)});
  }
  return result;
}

using GoldenTrees = golden::InEachFolder;

TEST_P(GoldenTrees, LeftFoldErrorAndBound) {
  const Table table = read("sardf_tree_error");
  const double R = table.parameter("R");
  const nlohmann::json unite = {"union", "a", "b", "c", "d"};
  const nlohmann::json intersect = {"intersection", "a", "b", "c", "d"};
  const nlohmann::json tree = table.header["tree"];
  const BlendPointer sardf = blend_of("sardf", R), min_max = min_max_blend();
  double largest_error = 0;
  for (const std::vector<double>& row : table.rows) {
    // Three of the four values are coordinates; the fourth is a constant.
    const std::map<std::string, Expression> leaves{{"a", coordinate(0)},
                                                   {"b", coordinate(1)},
                                                   {"c", coordinate(2)},
                                                   {"d", constant(row[table.column("v3")])}};
    const Vec3 at{row[table.column("v0")], row[table.column("v1")], row[table.column("v2")]};
    const auto value = [&](const nlohmann::json& of, const Blend& blend) {
      return Evaluator(tree_of(of, blend, leaves)).value(at);
    };
    EXPECT_NEAR(value(intersect, *sardf), row[table.column("nary_intersection")],
                table.tolerance());
    EXPECT_NEAR(value(unite, *sardf), row[table.column("nary_union")], table.tolerance());
    EXPECT_NEAR(value(tree, *sardf), row[table.column("tree")], table.tolerance());
    const double error = std::abs(value(tree, *sardf) - value(tree, *min_max));
    EXPECT_NEAR(error, std::abs(row[table.column("tree_error")]), table.tolerance());
    largest_error = std::max(largest_error, error);
  }
  const Expression whole = tree_of(
      tree, *sardf,
      {{"a", coordinate(0)}, {"b", coordinate(1)}, {"c", coordinate(2)}, {"d", constant(1)}});
  EXPECT_NEAR(error_bound(whole), table.header["bound"].get<double>(), table.tolerance());
  EXPECT_LE(largest_error, error_bound(whole));
  EXPECT_GT(largest_error, 0);
}

INSTANTIATE_TEST_SUITE_P(Each, GoldenTrees, golden::each_folder(), golden::folder_name);

// Two ellipsoids joined (paper, section 5, Figs. 14 and 15).
using GoldenEllipsoids = golden::EachFolderWith<const char*>;

TEST_P(GoldenEllipsoids, ThreeUnions) {
  const Table table = read(this_case());
  const auto vector = [&](const char* name) {
    const nlohmann::json& v = table.parameter(name);
    return Vec3{v[0], v[1], v[2]};
  };
  const std::vector<Field> parts{make_field("ellipsoid", {vector("c1"), vector("r1")}),
                                 make_field("ellipsoid", {vector("c2"), vector("r2")})};
  const double R = table.parameter("R");
  const std::pair<const char*, const char*> unions[] = {
      {"sardf", "sardf"}, {"max", "min_max"}, {"rfun", "r_function"}};
  for (const auto& [column, blend] : unions) {
    const Evaluator whole(make_field("union", {parts, blend_of(blend, R)}).expression());
    for (const std::vector<double>& row : table.rows) {
      double value, gradient[3];
      whole.gradients(row.data(), 1, &value, gradient);
      EXPECT_NEAR(value, row[table.column(column)], table.tolerance());
      for (int axis = 0; axis < 3; ++axis) {
        const std::string name = std::string(column) + "_g" + char('x' + axis);
        const double expected = row[table.column(name)];
        if (std::isnan(expected)) continue;
        EXPECT_NEAR(gradient[axis], expected, table.tolerance()) << name;
      }
      const float point[3] = {float(row[0]), float(row[1]), float(row[2])};
      float single;
      whole.values(point, 1, &single);
      const double most = std::max({abs(row[0]), abs(row[1]), abs(row[2]), 10.0});
      EXPECT_NEAR(single, row[table.column(column)], 1e-5 * most);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, GoldenEllipsoids,
                         testing::Combine(golden::each_folder(),
                                          testing::Values("fig_sardf_14_15_3d",
                                                          "fig_sardf_14_15_section")),
                         [](const auto& of) {
                           return golden::test_name(std::get<0>(of.param)) + "_" +
                                  std::get<1>(of.param);
                         });

}  // namespace
}  // namespace sardf
