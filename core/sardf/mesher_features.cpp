// Vertices on sharp edges and corners.
//
// Each face around a vertex has a crossing, which lies on the surface and on one side of the edge.
// The surface near the vertex is sampled from the vertex towards each crossing, at distances that
// shrink: the planes tangent there meet, to second order, in the edge or corner. Where the normals
// come together as the distance shrinks, there is no edge but a narrow fillet.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "sardf/mesher_samples.hpp"

namespace sardf::mesher {

namespace {

// Distances of the samples from the vertex, in cells: most vertices need the first and the
// nearest only.
constexpr double first_distance = 0.3;
constexpr double distances[] = {first_distance, 0.1, 0.03, nearest_distance, nearest_distance};
// A vertex that moves so far in the last step, in cells, goes through all distances, as does one
// that may have lost a side on the way, and one that moves so little is where it belongs.
constexpr double long_step = 0.01, short_step = 1e-5;
// Directions in which the normals tell less than this, relative to the best, are left alone: the
// sides of an edge make 2 atan(sqrt(0.03)) = 20 degrees.
constexpr double least_weight = 0.03;
// How far a vertex may leave its room at first, and how far one step goes at most, in cells.
constexpr double slack_in_cells = 1, longest_step = 4;
// Distances from the surface, in cells: wanted, and accepted when it comes no nearer.
constexpr double wanted_distance = 1e-6, accepted_distance = 1e-3;

// Between these the directions tell neither that there is an edge nor that there is none.
constexpr double unclear_weights[] = {least_weight / 4, least_weight * 4};

struct Meeting {
  Vec3 step;
  bool is_clear;  // whether the directions that count clearly do
};

// From `origin` to the nearest point on the planes of all sides, in the sense of least squares:
// every side counts alike, however many samples it has.
Meeting meeting_point(std::span<const Sample> samples, int sides, const Vec3& origin) {
  std::array<double, most_sides> weight{};
  for (const Sample& s : samples) {
    if (s.side >= 0) ++weight[s.side];
  }
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const Sample& s : samples) {
    if (s.side < 0) continue;
    const Eigen::Vector3d normal(s.normal[0], s.normal[1], s.normal[2]);
    const double w = 1 / weight[s.side];
    matrix += w * normal * normal.transpose();
    right += w * (dot(s.normal, s.at - origin) - s.height) * normal;
  }
  // In closed form: right to 1e-8, which the next step makes up for.
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(matrix);
  Eigen::Vector3d step = Eigen::Vector3d::Zero();
  bool is_clear = true;
  for (int i = 0; i < 3; ++i) {
    const double value = solver.eigenvalues()[i];
    const double share = value / solver.eigenvalues()[2];
    is_clear = is_clear && !(share > unclear_weights[0] && share < unclear_weights[1]);
    if (value < least_weight * solver.eigenvalues()[2] || !(value > 1e-9 * sides)) continue;
    step += solver.eigenvectors().col(i) * (solver.eigenvectors().col(i).dot(right) / value);
  }
  return {{step[0], step[1], step[2]}, is_clear};
}

double least_steepness(std::span<const Sample> samples) {
  double least = infinity;
  for (const Sample& s : samples) {
    if (s.side >= 0) least = std::min(least, s.steepness);
  }
  return least < infinity ? least : 0;
}

class Features {
 public:
  /// `slack`: how far a vertex may leave its room.
  Features(const Field& field, const Grid& grid, const Places& places, Vertices& vertices,
           double slack)
      : field_(field), grid_(grid), places_(places), vertices_(vertices), slack_(slack) {}

  void place(std::span<const uint32_t> numbers) const {
    Samples samples(places_, numbers);
    start(samples);
    const std::vector<Step> at_crossings = solve(samples);
    const std::vector<Step> first = approach(samples, first_distance);
    const std::vector<Step> last = approach(samples, nearest_distance);
    std::vector<uint32_t> far, near;
    for (size_t k = 0; k < numbers.size(); ++k) {
      if (last[k].sides < std::max(first[k].sides, at_crossings[k].sides) || !first[k].is_clear ||
          !last[k].is_clear || !(last[k].length <= long_step)) {
        far.push_back(numbers[k]);
      } else if (last[k].length > short_step) {
        near.push_back(numbers[k]);
      } else {
        rescue(numbers[k], samples.of(k));
      }
    }
    Samples far_samples(places_, far), near_samples(places_, near);
    if (!far.empty()) {
      for (const double distance : distances) approach(far_samples, distance);
    }
    if (!near.empty()) approach(near_samples, nearest_distance);
    for (Samples* of : {&far_samples, &near_samples}) {
      for (size_t k = 0; k < of->vertex_count(); ++k) rescue(of->vertex(k), of->of(k));
    }
  }

 private:
  struct Step {
    double length = infinity;  // in cells, before it was cut short by the room
    int sides = 0;
    bool is_clear = false;
  };

  Vec3 in_room(const Vec3& point, uint32_t vertex) const {
    const Vec3 slack{slack_, slack_, slack_};
    const BoundingBox room = places_.room(vertex);
    return clamped(point, {room.lo - slack, room.hi + slack});
  }

  // Each vertex to the middle of its crossings.
  void start(Samples& samples) const {
    for (size_t k = 0; k < samples.vertex_count(); ++k) {
      Vec3 sum{};
      for (const Sample& sample : samples.of(k)) sum = sum + sample.at;
      const uint32_t v = samples.vertex(k);
      vertices_.at[v] = in_room((1.0 / double(samples.of(k).size())) * sum, v);
    }
  }

  // One step from samples at a distance; and what each vertex did.
  std::vector<Step> approach(Samples& samples, double distance) const {
    samples.take(field_, vertices_.at, distance * grid_.cell);
    return solve(samples);
  }

  std::vector<Step> solve(Samples& samples) const {
    std::vector<Step> steps(samples.vertex_count());
    for (size_t k = 0; k < samples.vertex_count(); ++k) {
      Vec3& at = vertices_.at[samples.vertex(k)];
      const int sides = find_sides(samples.of(k));
      if (sides == 0) continue;
      const auto [step, is_clear] = meeting_point(samples.of(k), sides, at);
      if (norm(step) < longest_step * grid_.cell) at = in_room(at + step, samples.vertex(k));
      steps[k] = {norm(step) / grid_.cell, sides, is_clear};
    }
    return steps;
  }

  // A vertex that is not on the surface goes there by plain steps, else to the nearest crossing.
  void rescue(uint32_t v, std::span<const Sample> samples) const {
    const double one_cell = grid_.cell * least_steepness(samples);
    Points<double> points;
    Vec3 at = vertices_.at[v];
    double nearest = infinity;
    for (int step = 0; step < 12 && !(nearest <= wanted_distance * one_cell); ++step) {
      points.set(0, at);
      field_.differentiate(points, 1);
      const double value = points.value[0];
      if (std::abs(value) < nearest) {
        nearest = std::abs(value);
        vertices_.at[v] = at;
      }
      at = in_room(at + newton_step(value, points.gradient_at(0)), v);
    }
    if (!(nearest <= accepted_distance * one_cell)) vertices_.at[v] = nearest_crossing(v, samples);
  }

  Vec3 nearest_crossing(uint32_t v, std::span<const Sample> samples) const {
    const auto distance = [&](const Sample& s) {
      return norm(places_.crossing(s.use / 4) - vertices_.at[v]);
    };
    const auto best = std::min_element(
        samples.begin(), samples.end(),
        [&](const Sample& a, const Sample& b) { return distance(a) < distance(b); });
    return in_room(places_.crossing(best->use / 4), v);
  }

  const Field& field_;
  const Grid& grid_;
  const Places& places_;
  Vertices& vertices_;
  double slack_;
};

}  // namespace

void place_features(const Field& field, const Grid& grid, const Net& net, const Places& places,
                    Vertices& vertices, Work& work) {
  const auto place = [&](const std::vector<uint32_t>& numbers, double slack) {
    const Features features(field, grid, places, vertices, slack);
    work.run(numbers.size(), 32, [&](size_t first, size_t last) {
      features.place(std::span(numbers).subspan(first, last - first));
    });
  };
  place(vertices.sharp, slack_in_cells * grid.cell);
  auto numbers = vertices_to_take_back(grid, net, places, vertices, work);
  if (make_room(field, grid, net, places, numbers, vertices)) {
    numbers = vertices_to_take_back(grid, net, places, vertices, work);
  }
  // Those that were taken back stay in their room, so this ends.
  while (!numbers.empty()) {
    place(numbers, 0);
    numbers = vertices_to_take_back(grid, net, places, vertices, work);
  }
}

}  // namespace sardf::mesher
