// Solids from contours: the implicit polygon, and lofts between plane fields.
#pragma once

#include "sardf/contour.hpp"
#include "sardf/shapes_combine.hpp"

namespace sardf {

/// Every edge's line enters once: the lines of the convex hull's edges are intersected, a pocket
/// between two hull corners is the union of the lines of its own hull, and so on alternating.
/// Source: Rvachev 1974, as used by Fayolle, Pasko, Schmitt, Mirenkov 2004, section 6.3.
struct ImplicitPolygon {
  static constexpr const char *name = "implicit_polygon", *group = "plane",
                              *doc =
                                  "The inside of a closed contour without self-intersections, as "
                                  "unions and intersections of its edges' lines. Its sign is the "
                                  "polygon's; its value is no distance, since edges are extended "
                                  "to lines.";
  Contour vertices;
  BlendPointer blend = min_max_blend();
  template <class V>
  static void parameters(V& v) {
    v(Parameter{"vertices", "its corners in order, either way round", Unit::length, Range::any,
                true, 3},
      &ImplicitPolygon::vertices);
    v(Parameter{"blend", "how the lines are joined"}, &ImplicitPolygon::blend);
  }
  Expression expression() const;
  Quality quality() const { return {}; }
};

/// Between two heights the field is interpolated: linearly, or by cubics with a continuous slope
/// that nowhere leave the range of the two fields. Source: Fritsch and Carlson 1980, "Monotone
/// piecewise cubic interpolation", with van Leer's limit of the slopes (1977, "Towards the ultimate
/// conservative difference scheme IV").
struct Loft {
  static constexpr const char *name = "loft", *group = "solid",
                              *doc =
                                  "A solid through plane fields at several heights, cut off at "
                                  "the lowest and the highest. Between them the fields are "
                                  "interpolated, which gives no distance.";
  std::vector<PlaneSection> sections;
  std::string interpolation = "smooth";
  template <class V>
  static void parameters(V& v) {
    v(Parameter{"sections", "plane fields and their heights, from the lowest to the highest",
                Unit::length, Range::any, true, 2},
      &Loft::sections);
    v(Parameter{"interpolation",
                "'smooth': the sides have no crease at a section; 'linear': straight in between"},
      &Loft::interpolation);
  }
  Expression expression() const;
  Quality quality() const { return {}; }
};

using ContourShapes = OpList<ImplicitPolygon, Loft>;

}  // namespace sardf
