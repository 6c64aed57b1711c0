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

// Distances of the samples from the vertex, in cells.
constexpr double distances[] = {0.3, 0.1, 0.03, nearest_distance, nearest_distance};
// Directions in which the normals tell less than this, relative to the best, are left alone: the
// sides of an edge make 2 atan(sqrt(0.03)) = 20 degrees.
constexpr double least_weight = 0.03;
// How far a vertex may leave its room at first, and how far one step goes at most, in cells.
constexpr double slack_in_cells = 1, longest_step = 4;
// Distances from the surface, in cells: wanted, and accepted when it comes no nearer.
constexpr double wanted_distance = 1e-6, accepted_distance = 1e-3;

// From `origin` to the nearest point on the planes of all sides, in the sense of least squares:
// every side counts alike, however many samples it has.
Vec3 meeting_point(std::span<const Sample> samples, int sides, const Vec3& origin) {
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
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(matrix);
  Eigen::Vector3d step = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const double value = solver.eigenvalues()[i];
    if (value < least_weight * solver.eigenvalues()[2] || !(value > 1e-9 * sides)) continue;
    step += solver.eigenvectors().col(i) * (solver.eigenvectors().col(i).dot(right) / value);
  }
  return {step[0], step[1], step[2]};
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
  Features(const Field& field, const Grid& grid, const Net& net, const CrossingPoints& crossings,
           Vertices& vertices, double slack)
      : field_(field),
        grid_(grid),
        net_(net),
        crossings_(crossings),
        vertices_(vertices),
        slack_(slack) {}

  void place(std::span<const uint32_t> numbers) const {
    Samples samples(net_, crossings_, numbers);
    start(samples);
    solve(samples);
    for (const double distance : distances) {
      samples.take(field_, vertices_, distance * grid_.cell);
      solve(samples);
    }
    samples.take(field_, vertices_, nearest_distance * grid_.cell);
    for (size_t k = 0; k < numbers.size(); ++k) rescue(numbers[k], samples.of(k));
  }

 private:
  Vec3 in_room(const Vec3& point, uint32_t vertex) const {
    const Vec3 slack{slack_, slack_, slack_};
    return clamped(point, {net_.room[vertex].lo - slack, net_.room[vertex].hi + slack});
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

  void solve(Samples& samples) const {
    for (size_t k = 0; k < samples.vertex_count(); ++k) {
      Vec3& at = vertices_.at[samples.vertex(k)];
      const int sides = find_sides(samples.of(k));
      if (sides == 0) continue;
      const Vec3 step = meeting_point(samples.of(k), sides, at);
      if (norm(step) < longest_step * grid_.cell) at = in_room(at + step, samples.vertex(k));
    }
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
      return norm(crossings_.at[s.use / 4] - vertices_.at[v]);
    };
    const auto best = std::min_element(
        samples.begin(), samples.end(),
        [&](const Sample& a, const Sample& b) { return distance(a) < distance(b); });
    return in_room(crossings_.at[best->use / 4], v);
  }

  const Field& field_;
  const Grid& grid_;
  const Net& net_;
  const CrossingPoints& crossings_;
  Vertices& vertices_;
  double slack_;
};

}  // namespace

void place_features(const Field& field, const Grid& grid, const Net& net,
                    const CrossingPoints& crossings, Vertices& vertices, Work& work) {
  const auto place = [&](const std::vector<uint32_t>& numbers, double slack) {
    const Features features(field, grid, net, crossings, vertices, slack);
    work.run(numbers.size(), 32, [&](size_t first, size_t last) {
      features.place(std::span(numbers).subspan(first, last - first));
    });
  };
  place(vertices.sharp, slack_in_cells * grid.cell);
  // Those that were taken back stay in their room, so this ends.
  for (;;) {
    const auto numbers = vertices_to_take_back(grid, net, crossings, vertices);
    if (numbers.empty()) break;
    place(numbers, 0);
  }
}

}  // namespace sardf::mesher
