// The surface in several boxes: nothing of it is lost, and the picture is that of the whole.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "povray_gen/pieces.hpp"
#include "povray_gen/run.hpp"
#include "povray_gen/scene_text.hpp"
#include "povray_harness.hpp"
#include "sardf/image_file.hpp"
#include "sardf/operation_of.hpp"
#include "sardf/ops.hpp"

namespace sardf {
namespace {

using povray::Look;
using povray::Piece;
using povray::PovrayScene;
using povray::SceneText;

const Expression X = coordinate(0), Y = coordinate(1), Z = coordinate(2);
const BoundingBox bounds{{-10.1, -6.1, -4.1}, {10.1, 6.1, 4.1}};

template <class Op>
Expression in_space(const Op& op) {
  return call(make_operation(op), {X, Y, Z});
}

/// A plate with eleven holes through its edges and faces, rounded by SARDF.
Expression plate_of_many_holes() {
  Box plate;
  plate.size = {20, 12, 8};
  Expression part = in_space(plate);
  const auto difference = make_operation(DifferenceOf<Sardf>(Sardf{.radius = 0.5}));
  for (int i = 0; i < 11; ++i) {
    Cylinder hole;
    hole.center = {-10.0 + 2 * i, i % 2 ? 4.0 : -4.0, 0};
    hole.radius = 1.5;
    part = call(difference, {part, in_space(hole)});
  }
  return part;
}

/// Steep off its surface: a ball of radius 3 by its squared distance.
Expression quadratic_ball() {
  const auto square_of = [](const Expression& a) {
    return call(make_operation(Multiply()), {a, a});
  };
  const auto plus = make_operation(Add());
  return call(make_operation(Subtract()),
              {constant(9), call(plus, {call(plus, {square_of(X), square_of(Y)}), square_of(Z)})});
}

povray::PieceOptions options_for(double gradient) {
  povray::PieceOptions options;
  options.accuracy = 1e-5 * bounds.diagonal();
  options.overlap = options.reach = 4 * options.accuracy;
  options.gradient = gradient;
  return options;
}

bool contains(const BoundingBox& box, const Vec3& p, double grown = 0) {
  for (int axis = 0; axis < 3; ++axis) {
    if (p[axis] < box.lo[axis] - grown || p[axis] > box.hi[axis] + grown) return false;
  }
  return true;
}

Vec3 random_point(std::mt19937& random, const BoundingBox& box) {
  Vec3 p;
  for (int axis = 0; axis < 3; ++axis) {
    p[axis] = std::uniform_real_distribution(box.lo[axis], box.hi[axis])(random);
  }
  return p;
}

TEST(PovrayPieces, HoldAllOfTheSurfaceAndTheSameValues) {
  const Expression solid = plate_of_many_holes();
  const auto options = options_for(1.2);
  const std::vector<Piece> pieces = povray::pieces_of(solid, bounds, options);
  ASSERT_GT(pieces.size(), 4u);
  const Evaluator whole(solid);
  std::vector<Evaluator> near;
  for (const Piece& piece : pieces) near.emplace_back(piece.solid);
  std::mt19937 random(7);
  int crossings = 0;
  for (int k = 0; k < 20'000; ++k) {
    // Where a segment crosses the surface, found by halving.
    Vec3 a = random_point(random, bounds), b = random_point(random, bounds);
    const bool inside = whole.value(a) >= 0;
    if (inside == (whole.value(b) >= 0)) continue;
    ++crossings;
    for (int halving = 0; halving < 50; ++halving) {
      const Vec3 middle = 0.5 * (a + b);
      ((whole.value(middle) >= 0) == inside ? a : b) = middle;
    }
    int holders = 0;
    for (size_t i = 0; i < pieces.size(); ++i) {
      if (!contains(pieces[i].box, a, options.reach)) continue;
      EXPECT_EQ(near[i].value(a), whole.value(a));
      holders += contains(pieces[i].box, a, -0.5 * options.overlap);
    }
    EXPECT_GE(holders, 1) << "not even half of the overlap deep in a piece";
  }
  EXPECT_GT(crossings, 1000);
}

TEST(PovrayPieces, AreShorterThanTheWhole) {
  const Expression solid = plate_of_many_holes();
  const std::vector<Piece> pieces = povray::pieces_of(solid, bounds, options_for(1.2));
  double instructions = 0;
  for (const Piece& piece : pieces) {
    instructions += double(Evaluator(piece.solid).tape().instructions().size());
  }
  const size_t whole = Evaluator(solid).tape().instructions().size();
  EXPECT_LT(instructions / double(pieces.size()), 0.5 * double(whole));
}

TEST(PovrayPieces, AreShorterStillWhereOnlySignsCount) {
  const Expression solid = plate_of_many_holes();
  auto options = options_for(1.2);
  const auto mean_size = [](const std::vector<Piece>& pieces) {
    double instructions = 0;
    for (const Piece& piece : pieces) {
      instructions += double(Evaluator(piece.solid).tape().instructions().size());
    }
    return instructions / double(pieces.size());
  };
  const double exact = mean_size(povray::pieces_of(solid, bounds, options));
  options.exact_within = 0.01;
  const std::vector<Piece> pieces = povray::pieces_of(solid, bounds, options);
  EXPECT_LT(mean_size(pieces), 0.95 * exact);
  const Evaluator whole(solid);
  std::mt19937 random(9);
  int near = 0;
  for (const Piece& piece : pieces) {
    const Evaluator shorter(piece.solid);
    const auto cut_off = [&](const Vec3& p) {
      return std::clamp(shorter.value(p), -piece.band, piece.band);
    };
    const auto exact_values = [](double a) { return std::clamp(a, -0.01, 0.01); };
    for (int k = 0; k < 3000; ++k) {
      const Vec3 a = random_point(random, piece.box);
      const Vec3 b = a + 0.01 * (random_point(random, piece.box) - a);
      ASSERT_EQ(exact_values(shorter.value(a)), exact_values(whole.value(a)));
      ASSERT_LE(std::abs(cut_off(a) - cut_off(b)), piece.gradient * norm(a - b) * (1 + 1e-9));
      near += std::abs(whole.value(a)) < 0.01;
    }
  }
  EXPECT_GT(near, 100);
}

// Of a rounded plate with holes the gradient is at most 1 near the surface; where rounded edges
// meet holes, a little more.
TEST(PovrayPieces, BoundsAreNearTheSteepestGradient) {
  for (const Expression& solid : {plate_of_many_holes(), quadratic_ball()}) {
    const Evaluator whole(solid);
    std::mt19937 random(10);
    double bound = 0, steepest = 0;
    for (const Piece& piece : povray::pieces_of(solid, bounds, options_for(1e9))) {
      bound = std::max(bound, piece.gradient);
      for (int k = 0; k < 4000; ++k) {
        const Vec3 p = random_point(random, piece.box);
        Vec3 gradient;
        double value = 0;
        whole.gradients(p.data(), 1, &value, gradient.data());
        if (std::abs(value) <= piece.band) steepest = std::max(steepest, norm(gradient));
      }
    }
    EXPECT_LE(bound, 1.15 * steepest);
    EXPECT_GE(bound, steepest);
  }
}

TEST(PovrayPieces, NoGradientOfTheCutOffValuesExceedsTheBound) {
  for (const Expression& solid : {plate_of_many_holes(), quadratic_ball()}) {
    const Evaluator whole(solid);
    std::mt19937 random(8);
    for (const Piece& piece : povray::pieces_of(solid, bounds, options_for(1e9))) {
      const auto cut_off = [&](const Vec3& p) {
        return std::clamp(whole.value(p), -piece.band, piece.band);
      };
      for (int k = 0; k < 2000; ++k) {
        const Vec3 a = random_point(random, piece.box);
        const Vec3 b = a + 0.01 * (random_point(random, piece.box) - a);
        ASSERT_LE(std::abs(cut_off(a) - cut_off(b)), piece.gradient * norm(a - b) * (1 + 1e-9));
      }
    }
  }
}

TEST(PovrayPieces, WhatIsSteepOffTheSurfaceIsCutOff) {
  const std::vector<Piece> pieces = povray::pieces_of(quadratic_ball(), bounds, options_for(1e9));
  for (const Piece& piece : pieces) {
    EXPECT_LT(piece.band, infinity);
    // The slope is 6 at the surface and 25 at the corners of the bounds.
    EXPECT_LT(piece.gradient, 10);
    EXPECT_GE(piece.gradient, 6 * 0.999);
  }
}

TEST(PovrayPieces, ProgressCancels) {
  povray::PieceOptions options = options_for(1.2);
  int asked = 0;
  options.progress = [&](double) { return ++asked < 5; };
  EXPECT_THROW(povray::pieces_of(plate_of_many_holes(), bounds, options), Cancelled);
}

class PovrayPiecesRender : public testing::Test {
 protected:
  PovrayScene scene(Look look) {
    PovrayScene out;
    out.title = "plate";
    out.solid = plate_of_many_holes();
    out.bounds = bounds;
    out.width = 100;
    out.height = 75;
    out.camera = frame_camera(bounds, out.width, out.height);
    out.look = look;
    return out;
  }
  /// In pieces, or as one isosurface with twice the bound.
  Image render(const PovrayScene& scene, SceneText text, bool whole) {
    if (whole) {
      const std::string macro = "#if (plate_csg)\n  isosurface";
      const size_t at = text.include.find(macro);
      EXPECT_NE(at, std::string::npos) << "there are no pieces";
      text.include.replace(at, macro.size(), "#if (yes)\n  isosurface");
      const std::string bound = "max_gradient " + povray::number_text(text.max_gradient);
      text.include.replace(text.include.find(bound), bound.size(),
                           "max_gradient " + povray::number_text(2 * text.max_gradient));
    }
    std::ofstream(folder_ / "scene.inc") << text.include;
    std::ofstream(folder_ / "scene.pov") << text.scene;
    povray::RunOptions options;
    options.width = scene.width;
    options.height = scene.height;
    povray::render(folder_ / "scene.pov", folder_ / "picture.exr", options);
    return read_image(folder_ / "picture.exr", Meaning::color);
  }
  /// The share of pixels that differ by more than `most`.
  double differing(const PovrayScene& scene, const SceneText& text, float most) {
    const Image pieces = render(scene, text, false), whole = render(scene, text, true);
    int count = 0;
    const int n = scene.width * scene.height;
    for (int i = 0; i < n; ++i) {
      float worst = 0;
      for (int k = 0; k < 4; ++k) {
        worst = std::max(worst, std::abs(pieces.samples[4 * i + k] - whole.samples[4 * i + k]));
      }
      count += worst > most;
    }
    return double(count) / n;
  }
  TestFolder folder_;
};

TEST_F(PovrayPiecesRender, ThePictureHasNoSeam) {
  const PovrayScene normals = scene(Look::normals);
  EXPECT_LE(differing(normals, povray::scene_text(normals, "scene.inc"), 0.002f), 0.001);
  // Where light grazes the surface, the shadow's edge moves with the accuracy.
  const PovrayScene shaded = scene(Look::shaded);
  EXPECT_LE(differing(shaded, povray::scene_text(shaded, "scene.inc"), 0.03f), 0.001);
}

TEST_F(PovrayPiecesRender, GlassLooksTheSame) {
  const PovrayScene whole = scene(Look::flat);
  SceneText text = povray::scene_text(whole, "scene.inc");
  text.scene =
      "#version 3.7;\nglobal_settings { assumed_gamma 1.0 max_trace_level 8 }\n"
      "#include \"scene.inc\"\n" +
      povray::camera_text(whole.camera, whole.width, whole.height) +
      "background { rgb <0.1, 0.2, 0.3> }\n"
      "plane { z, -20 pigment { checker rgb 0.1 rgb 0.9 scale 3 } finish { emission 1 } }\n"
      "object {\n  plate_isosurface()\n"
      "  texture { pigment { rgbt <0.8, 0.9, 0.8, 0.9> } finish { emission 0.1 } }\n"
      "  interior { ior 1.1 }\n}\n";
  // Rays that graze an edge may leave it on either side.
  EXPECT_LE(differing(whole, text, 0.002f), 0.01);
}

TEST(PovrayPiecesText, DependsOnNothingElse) {
  PovrayScene scene;
  scene.title = "plate";
  scene.solid = plate_of_many_holes();
  scene.bounds = bounds;
  scene.camera = frame_camera(bounds, 160, 120);
  EXPECT_EQ(povray::scene_text(scene, "a.inc").include, povray::scene_text(scene, "a.inc").include);
}

}  // namespace
}  // namespace sardf
