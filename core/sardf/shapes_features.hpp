// Features that carry data, and the union of features.
#pragma once

#include "sardf/bspline_pieces.hpp"
#include "sardf/shapes_combine.hpp"

namespace sardf {

/// The degree and the number of control points are checked in expression(), as all that depends on
/// several parameters.
/// Source of the distance: curve_search.hpp.
struct BSplineCurve {
  static constexpr const char *name = "bspline_curve", *group = "feature",
                              *doc =
                                  "The distance to a B-spline curve of any degree, rational where "
                                  "weights are given. It starts and ends in its first and last "
                                  "control point unless knots say otherwise or it is closed.";
  std::vector<Vec3> control_points;
  double degree = 3;
  std::vector<double> knots, weights;
  bool closed = false;
  template <class V>
  static void parameters(V& v) {
    v(Parameter{"control_points", "its control points in order, more than the degree", Unit::length,
                Range::any, true, 2},
      &BSplineCurve::control_points);
    v(Parameter{"degree", "degree of its pieces: a whole number from 1 to 12"},
      &BSplineCurve::degree);
    v(Parameter{"knots",
                "its knots, which never fall, as many as control points and degree and 1; none: "
                "clamped and uniform"},
      &BSplineCurve::knots);
    v(Parameter{"weights", "a weight for each control point; none: all 1", Unit::none,
                Range::positive},
      &BSplineCurve::weights);
    v(Parameter{"closed", "whether it is closed, smoothly and with uniform knots"},
      &BSplineCurve::closed);
  }
  Expression expression() const;
  Quality quality() const { return {Exactness::exact, Exactness::exact}; }
};

struct BSplineSurface {
  static constexpr const char *name = "bspline_surface", *group = "feature",
                              *doc =
                                  "The distance to a B-spline surface of any degrees, rational "
                                  "where weights are given, its edges included.";
  PointGrid control_points;
  double degree_u = 3, degree_v = 3;
  std::vector<double> knots_u, knots_v, weights;
  bool closed_u = false, closed_v = false;
  template <class V>
  static void parameters(V& v) {
    v(Parameter{"control_points",
                "rows of control points, all of one length: u counts the rows, v along them",
                Unit::length, Range::any, true, 2},
      &BSplineSurface::control_points);
    v(Parameter{"degree_u", "degree across the rows: a whole number from 1 to 12"},
      &BSplineSurface::degree_u);
    v(Parameter{"degree_v", "degree along the rows: a whole number from 1 to 12"},
      &BSplineSurface::degree_v);
    v(Parameter{"knots_u",
                "knots across the rows, which never fall, as many as rows and degree and 1; none: "
                "clamped and uniform"},
      &BSplineSurface::knots_u);
    v(Parameter{"knots_v", "knots along the rows"}, &BSplineSurface::knots_v);
    v(Parameter{"weights", "a weight for each control point, row after row; none: all 1",
                Unit::none, Range::positive},
      &BSplineSurface::weights);
    v(Parameter{"closed_u", "whether the last row joins the first, smoothly"},
      &BSplineSurface::closed_u);
    v(Parameter{"closed_v", "whether the end of each row joins its start, smoothly"},
      &BSplineSurface::closed_v);
  }
  Expression expression() const;
  Quality quality() const { return {Exactness::exact, Exactness::exact}; }
};

struct Skeleton {
  static constexpr const char *name = "skeleton", *group = "feature",
                              *doc = "The distance to the nearest of several features.";
  std::vector<Field> of;
  template <class V>
  static void parameters(V& v) {
    v(Parameter{"of", "the features", Unit::none, Range::any, true, 1}, &Skeleton::of);
  }
  Expression expression() const;
  Quality quality() const;
};

using FeatureShapes = OpList<BSplineCurve, BSplineSurface, Skeleton>;

}  // namespace sardf
