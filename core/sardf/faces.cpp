#include "sardf/faces.hpp"

#include <set>

#include "sardf/arithmetic.hpp"
#include "sardf/contour.hpp"
#include "sardf/ops_features.hpp"
#include "sardf/ops_plane.hpp"
#include "sardf/shapes_transform.hpp"
#include "sardf/short_number.hpp"

namespace sardf {

namespace {

using Chosen = std::vector<size_t>;
using Point3 = std::array<Expression, 3>;

Point3 xyz() { return {coordinate(0), coordinate(1), coordinate(2)}; }

// The smallest of what `distance` gives for each of the numbers.
template <class Distance>
Expression nearest(const Chosen& chosen, Distance distance) {
  Expression best = distance(chosen[0]);
  for (size_t i = 1; i < chosen.size(); ++i) best = min(best, distance(chosen[i]));
  return best;
}

// How far a coordinate is from the interval of a half width around 0.
Expression beyond(const Expression& a, double half) {
  return max(abs(a) - constant(half), constant(0));
}

// The distance from a point of a plane to a chain of straight segments.
Expression to_chain(const Expression& a, const Expression& b, const Contour& corners) {
  Polyline chain;
  for (const Vec2& corner : corners) chain.vertices.push_back({corner[0], corner[1], 0});
  return call(make_operation(chain), {a, b, constant(0)});
}

// The flat parts of a box whose edges are rounded by a radius, which may be 0.
Faces faces_of_box(const Vec3& center, const Vec3& size, double radius) {
  return {6, [=](const Chosen& chosen) {
            return nearest(chosen, [&](size_t face) {
              const size_t across = face / 2, b = (across + 1) % 3, c = (across + 2) % 3;
              const Vec3 half = 0.5 * size;
              const auto from = [&](size_t axis, double place) {
                return coordinate(int(axis)) - constant(place);
              };
              const double side = face % 2 ? half[across] : -half[across];
              return function("length3", {from(across, center[across] + side),
                                          beyond(from(b, center[b]), half[b] - radius),
                                          beyond(from(c, center[c]), half[c] - radius)});
            });
          }};
}

Faces faces_of_rectangle(const Box2d& box) {
  return {4, [box](const Chosen& chosen) {
            return nearest(chosen, [&](size_t edge) {
              const size_t across = edge / 2, along = 1 - across;
              const double half = 0.5 * box.size[across];
              const double place = box.center[across] + (edge % 2 ? half : -half);
              return length(coordinate(int(across)) - constant(place),
                            beyond(coordinate(int(along)) - constant(box.center[along]),
                                   0.5 * box.size[along]));
            });
          }};
}

// Bottom, top and side of a solid of revolution: three segments of the half-plane of the radius and
// the height, in which the nearest point of each lies.
Faces faces_of_turned(const Vec3& center, const Axis& axis, double bottom, double top,
                      double height) {
  return {3, [=](const Chosen& chosen) {
            Frame frame;
            frame.set(center, axis);
            Point3 from = xyz(), local;
            for (size_t i = 0; i < 3; ++i) from[i] = from[i] - constant(center[i]);
            for (size_t i = 0; i < 3; ++i) local[i] = affine(from, frame.rows()[i], 0);
            const Expression radius = length(local[0], local[1]);
            const Vec2 low{bottom, -0.5 * height}, high{top, 0.5 * height};
            const Contour sections[] = {{{0, low[1]}, low}, {{0, high[1]}, high}, {low, high}};
            return nearest(chosen,
                           [&](size_t face) { return to_chain(radius, local[2], sections[face]); });
          }};
}

// Edges that follow each other make one chain.
Expression to_edges(const Contour& corners, const Chosen& edges) {
  Expression best;
  for (size_t i = 0; i < edges.size();) {
    Contour chain{corners[edges[i]]};
    do {
      chain.push_back(corners[(edges[i] + 1) % corners.size()]);
      ++i;
    } while (i < edges.size() && edges[i] == edges[i - 1] + 1);
    const Expression distance = to_chain(coordinate(0), coordinate(1), chain);
    best = best ? min(best, distance) : distance;
  }
  return best;
}

Faces faces_of_extruded(const Field& profile, double height) {
  const Faces edges = numbered_faces(profile);
  if (edges.count == 0) return {};
  return {edges.count + 2, [=](const Chosen& chosen) {
            Chosen walls;
            Expression best;
            const auto add = [&](const Expression& distance) {
              best = best ? min(best, distance) : distance;
            };
            for (const size_t face : chosen) {
              if (face < edges.count) {
                walls.push_back(face);
                continue;
              }
              const double place = (face == edges.count ? -0.5 : 0.5) * height;
              add(length(max(-profile.expression(), constant(0)), coordinate(2) - constant(place)));
            }
            if (!walls.empty()) {
              add(length(edges.distance(walls), beyond(coordinate(2), 0.5 * height)));
            }
            return best;
          }};
}

Faces faces_of_moved(const Construction& made) {
  const Faces still = numbered_faces(std::get<Field>(made.arguments[0]));
  if (still.count == 0) return {};
  return {still.count, [still, constructor = made.constructor,
                        arguments = made.arguments](const Chosen& chosen) {
            std::vector<Value> with_faces = arguments;
            with_faces[0] = Field(still.distance(chosen), {}, nullptr);
            return constructor->make(*constructor, std::move(with_faces)).expression();
          }};
}

Error no_faces(const Field& solid) {
  const Construction* made = solid.construction();
  std::string what = "a formula";
  if (made && made->constructor) what = "'" + made->constructor->name + "'";
  return Error(
      "the solid is " + what +
      ", whose faces have no numbers; they are counted for box, rounded_box, cylinder with a "
      "height, cone, box2d, polygon, extrude of the last two, and these moved by "
      "translate, rotate, scale or mirror");
}

Chosen chosen_faces(const std::vector<double>& numbers, size_t count) {
  std::set<size_t> chosen;
  for (const double number : numbers) {
    if (number >= 0 && number < double(count) && number == std::floor(number)) {
      chosen.insert(size_t(number));
      continue;
    }
    throw Error("there is no face " + short_number(number, 6) + ": the solid has " +
                std::to_string(count) + " faces, numbered from 0 to " + std::to_string(count - 1));
  }
  return {chosen.begin(), chosen.end()};
}

// The zero set of u cut down to where t >= 0.
Expression trimmed(const Expression& u, const Expression& t) {
  const Expression cut = length(t, function("square", {u})) - t;
  return length(u, constant(0.5) * cut);
}

}  // namespace

Faces numbered_faces(const Field& solid) {
  const Construction* made = solid.construction();
  if (!made || !made->constructor) return {};
  const std::string& name = made->constructor->name;
  if (name == Box::name) {
    const auto box = with_arguments<Box>(made->arguments);
    return faces_of_box(box.center, box.size, 0);
  }
  if (name == RoundedBox::name) {
    const auto box = with_arguments<RoundedBox>(made->arguments);
    return faces_of_box(box.center, box.size, box.radius);
  }
  if (name == Box2d::name) return faces_of_rectangle(with_arguments<Box2d>(made->arguments));
  if (name == Cylinder::name) {
    const auto bar = with_arguments<Cylinder>(made->arguments);
    if (!bar.height) return {};
    return faces_of_turned(bar.center, bar.axis, bar.radius, bar.radius, *bar.height);
  }
  if (name == Cone::name) {
    const auto cone = with_arguments<Cone>(made->arguments);
    return faces_of_turned(cone.center, cone.axis, cone.radius_bottom, cone.radius_top,
                           cone.height);
  }
  if (name == Polygon::name) {
    const Contour corners = with_arguments<Polygon>(made->arguments).vertices;
    return {corners.size(), [corners](const Chosen& edges) { return to_edges(corners, edges); }};
  }
  if (name == Extrude::name) {
    const auto extruded = with_arguments<Extrude>(made->arguments);
    return faces_of_extruded(extruded.field, extruded.height);
  }
  for (const char* moving : {Translate::name, Rotate::name, Scale::name, Mirror::name}) {
    if (name == moving) return faces_of_moved(*made);
  }
  return {};
}

Expression Boundary::expression() const {
  Expression distance = abs(solid.expression());
  if (!faces.empty()) {
    const Faces all = numbered_faces(solid);
    if (all.count == 0) throw no_faces(solid);
    distance = all.distance(chosen_faces(faces, all.count));
  }
  return where ? trimmed(distance, where->expression()) : distance;
}

Quality Boundary::quality() const {
  if (where) return {};
  const Quality q = solid.quality();
  const Exactness how = faces.empty() ? std::max(q.inside, q.outside) : Exactness::exact;
  return {how, how};
}

}  // namespace sardf
