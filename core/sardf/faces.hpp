// The boundary of a solid as a feature: all of it, numbered faces of it, or a part cut out by a
// field.
#pragma once

#include <functional>

#include "sardf/constructor_of.hpp"
#include "sardf/op_list.hpp"

namespace sardf {

/// The faces of a solid by number.
struct Faces {
  size_t count = 0;
  /// The exact distance to the nearest of some faces, whose numbers are sorted and less than count.
  std::function<Expression(const std::vector<size_t>&)> distance;
};

/// `count` is 0 for a solid without numbered faces. Numbered are those of
///   box       -x, +x, -y, +y, -z, +z
///   rounded_box  the same: its flat parts
///   cylinder with a height, and cone:  bottom, top, side
///   box2d     -x, +x, -y, +y; independent of z
///   polygon   edge i from corner i to the next; independent of z
///   extrude   the edges of its box2d or polygon as sheets, then the bottom and the top
/// and of these when they are moved by translate, rotate, scale or mirror. Faces are closed: they
/// hold their edges.
Faces numbered_faces(const Field& solid);

/// Source of `where`: Biswas, Shapiro 2004, "Approximate distance fields with non-vanishing
/// gradients", trimming: with f the distance and t the trimming field, the zero set of
/// sqrt(f² + ((sqrt(t² + f⁴) - t) / 2)²) is that of f where t >= 0.
struct Boundary {
  static constexpr const char *name = "boundary", *group = "feature",
                              *doc =
                                  "The distance to a solid's surface, from either side, or to a "
                                  "part of it.";
  Field solid;
  std::optional<Field> where;
  std::vector<double> faces;
  template <class V>
  static void parameters(V& v) {
    v(Parameter{"solid", "the solid", Unit::none, Range::any, true}, &Boundary::solid);
    v(Parameter{"where",
                "only the part of the surface where this field is not negative; the result is then "
                "an estimate of the distance, good to first order away from the part's rim"},
      &Boundary::where);
    v(Parameter{"faces",
                "only these faces, exactly. Of a box 0 to 5 are -x, +x, -y, +y, -z, +z, and of a "
                "rounded box its flat parts; of a cylinder with a height and of a cone 0 is the "
                "bottom, 1 the top, 2 the side; edges of a box2d are -x, +x, -y, +y; edge i of a "
                "polygon goes from corner i to the next; what is extruded has its edges, then the "
                "bottom, then the top. Moved solids keep their numbers"},
      &Boundary::faces);
  }
  /// Throws Error for faces that the solid does not have.
  Expression expression() const;
  Quality quality() const;
};

using FaceShapes = OpList<Boundary>;

}  // namespace sardf
