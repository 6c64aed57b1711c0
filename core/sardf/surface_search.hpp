// The nearest point of a Bezier patch, polynomial or rational, with certainty.
//
// As for curves (curve_search.hpp), with a Bernstein form in two variables: a patch is done with
// when no coefficient of g = |A|² - T² w² is negative; or when bounds g_uu >= a, g_vv >= b, |g_uv|
// <= m from second differences give ab > m², so that g is strongly convex, and at the minimum that
// Newton's iteration found g less ∇g·M⁻¹∇g/2 is not negative, M being the worst matrix within the
// bounds. Any other patch is split, at the coordinate of the minimum found where there is one
// inside: where a whole line is nearest (a point on a cylinder's axis), its sides then begin there.
// Patches are first held against the plane across the line of sight, which costs little.
#pragma once

#include <vector>

#include "sardf/bspline_pieces.hpp"

namespace sardf {

/// A point of a Bezier patch relative to an origin, with its derivatives by both parameters.
struct SurfacePoint {
  Vec3 at{}, u{}, v{}, uu{}, uv{}, vv{};
};

struct PatchDegrees {
  int u, v;
  size_t points() const { return size_t((u + 1) * (v + 1)); }
};

/// The state of a search: its point, and the best that is known.
struct SurfaceSearch {
  Vec3 point{};
  double rounding = 0;     // of coordinates: a distance below it is 0
  double squared = 1e300;  // the least squared distance found
  size_t part = 0;         // where: which patch, and its parameters
  Vec2 parameters{};

  /// What patches are compared with: the best distance less the tolerance.
  double distance_threshold() const;
  /// The same less rounding alone.
  double tight_threshold() const;
  /// Takes note of a point of the patch, also where the best one is nearer by rounding alone and
  /// this one `is_minimum`: of such points the minimum has the right direction.
  void note(double squared_there, size_t patch, const Vec2& at, bool is_minimum);
  /// Takes note of the patch's points that are nearer. `points`: rows of v, one for each u.
  void visit(const Weighted* points, PatchDegrees degrees, size_t patch);
  /// Last steps of Newton's iteration on the whole patch that the best point is on, where rounding
  /// is least. The distance has all its digits before; its direction needs twice as many.
  void polish(const Weighted* points, PatchDegrees degrees);
};

SurfacePoint surface_point(const Weighted* points, PatchDegrees degrees, const Vec2& at,
                           const Vec3& origin);

/// Splits a patch at t along u (axis 0) or v (axis 1).
void split_patch(const Weighted* points, PatchDegrees degrees, int axis, double t, Weighted* left,
                 Weighted* right);

}  // namespace sardf
