// Vertices on sharp edges and corners.
//
// Each face around a vertex has a crossing, which lies on the surface and on one side of the edge.
// The surface near the vertex is sampled from the vertex towards each crossing, at distances that
// shrink: the planes tangent there meet, to second order, in the edge or corner. Where the normals
// come together as the distance shrinks, there is no edge but a narrow fillet.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "sardf/mesher_stages.hpp"

namespace sardf::mesher {

namespace {

// Distances of the samples from the vertex, in cells.
constexpr double distances[] = {0.3, 0.1, 0.03, 0.01, 0.01};
// Normals that differ less belong to one side: cos(15 degrees).
constexpr double same_side = 0.9659;
// Directions in which the normals tell less than this, relative to the best, are left alone: the
// sides of an edge make 2 atan(sqrt(0.03)) = 20 degrees.
constexpr double least_weight = 0.03;
// How far a vertex may leave its room at first, in cells.
constexpr double slack_in_cells = 1;
// Distances from the surface, in cells: wanted, and accepted when it comes no nearer.
constexpr double wanted_distance = 1e-6, accepted_distance = 1e-3;

struct Sample {
  Vec3 at;
  Vec3 normal{};      // unit outward normal, 0: none
  double height = 0;  // of the sample above the surface along the normal
  double steepness = 0;
  int side = -1;
};

// The features of one part of the loop, with their samples: one for each use.
struct Batch {
  const uint32_t* vertices;
  size_t count;
  std::vector<uint32_t> first;  // of each feature, and the end of the last
  std::vector<Sample> samples;
};

class Features {
 public:
  Features(const Field& field, const Grid& grid, const Net& net, const CrossingPoints& crossings,
           Vertices& vertices, std::vector<Vec3>& corner_normals, double slack)
      : field_(field),
        grid_(grid),
        net_(net),
        crossings_(crossings),
        vertices_(vertices),
        corner_normals_(corner_normals),
        slack_(slack * grid.cell) {}

  void place(const uint32_t* numbers, size_t count) const {
    Batch batch{numbers, count, {}, {}};
    start(batch);
    solve(batch);
    for (const double distance : distances) {
      take_samples(batch, distance * grid_.cell);
      solve(batch);
    }
    take_samples(batch, distances[3] * grid_.cell);
    rescue(batch);
    take_samples(batch, distances[3] * grid_.cell);
    set_normals(batch);
  }

 private:
  uint32_t crossing_of(uint32_t vertex, uint32_t i) const {
    return net_.uses[net_.first_use[vertex] + i] / 4;
  }

  Vec3 in_room(const Vec3& point, uint32_t vertex) const {
    const Vec3 slack{slack_, slack_, slack_};
    return clamped(point, {net_.room[vertex].lo - slack, net_.room[vertex].hi + slack});
  }

  void start(Batch& batch) const {
    for (size_t k = 0; k < batch.count; ++k) {
      const uint32_t v = batch.vertices[k];
      batch.first.push_back(uint32_t(batch.samples.size()));
      const uint32_t uses = net_.first_use[v + 1] - net_.first_use[v];
      Vec3 sum{};
      for (uint32_t i = 0; i < uses; ++i) {
        const uint32_t c = crossing_of(v, i);
        batch.samples.push_back({crossings_.at[c], crossings_.normal[c]});
        sum = sum + crossings_.at[c];
      }
      vertices_.at[v] = (1.0 / uses) * sum;
    }
    batch.first.push_back(uint32_t(batch.samples.size()));
  }

  // Samples the field from each vertex towards the crossings, `distance` away or at the crossing.
  void take_samples(Batch& batch, double distance) const {
    for (size_t k = 0; k < batch.count; ++k) {
      const uint32_t v = batch.vertices[k];
      for (uint32_t s = batch.first[k]; s < batch.first[k + 1]; ++s) {
        const Vec3 way = crossings_.at[crossing_of(v, s - batch.first[k])] - vertices_.at[v];
        const double length = norm(way);
        batch.samples[s].at = vertices_.at[v] + (length > distance ? distance / length : 1) * way;
      }
    }
    Points<double> points;
    for (size_t begin = 0; begin < batch.samples.size(); begin += points.capacity) {
      const size_t n = std::min(points.capacity, batch.samples.size() - begin);
      for (size_t i = 0; i < n; ++i) points.set(i, batch.samples[begin + i].at);
      field_.differentiate(points, n);
      for (size_t i = 0; i < n; ++i) {
        Sample& sample = batch.samples[begin + i];
        const Vec3 gradient = points.gradient_at(i);
        sample.normal = outward_normal(gradient);
        sample.steepness = norm(gradient);
        sample.height = -points.value[i] / sample.steepness;
      }
    }
  }

  void solve(Batch& batch) const {
    for (size_t k = 0; k < batch.count; ++k) {
      const uint32_t v = batch.vertices[k];
      Sample* samples = &batch.samples[batch.first[k]];
      const size_t n = batch.first[k + 1] - batch.first[k];
      const int sides = find_sides(samples, n);
      if (sides == 0) continue;
      const Vec3 step = meeting_point(samples, n, sides, vertices_.at[v]);
      if (norm(step) < 4 * grid_.cell) {
        vertices_.at[v] = in_room(vertices_.at[v] + step, v);
      }
    }
  }

  // Gives each sample with a normal its side; the number of sides.
  static int find_sides(Sample* samples, size_t n) {
    std::array<Vec3, 16> first;
    int sides = 0;
    for (size_t i = 0; i < n; ++i) {
      Sample& sample = samples[i];
      sample.side = -1;
      if (!(dot(sample.normal, sample.normal) > 0.5) || !(std::abs(sample.height) < infinity)) {
        continue;
      }
      int side = 0;
      while (side < sides && dot(first[side], sample.normal) < same_side) ++side;
      if (side == sides) first[sides++] = sample.normal;
      sample.side = side;
    }
    return sides;
  }

  // From `origin` to the nearest point on the planes of all sides, in the sense of least squares:
  // every side counts alike, however many samples it has.
  static Vec3 meeting_point(const Sample* samples, size_t n, int sides, const Vec3& origin) {
    std::array<double, 16> weight{};
    for (size_t i = 0; i < n; ++i) {
      if (samples[i].side >= 0) ++weight[samples[i].side];
    }
    Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (size_t i = 0; i < n; ++i) {
      const Sample& s = samples[i];
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

  // Vertices that are not on the surface go there by plain steps, else to the nearest crossing.
  void rescue(const Batch& batch) const {
    Points<double> points;
    for (size_t k = 0; k < batch.count; ++k) {
      const uint32_t v = batch.vertices[k];
      const double one_cell = grid_.cell * steepness(batch, k);
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
      if (!(nearest <= accepted_distance * one_cell)) vertices_.at[v] = nearest_crossing(v);
    }
  }

  static double steepness(const Batch& batch, size_t k) {
    double least = infinity;
    for (uint32_t s = batch.first[k]; s < batch.first[k + 1]; ++s) {
      if (batch.samples[s].side >= 0) least = std::min(least, batch.samples[s].steepness);
    }
    return least < infinity ? least : 0;
  }

  Vec3 nearest_crossing(uint32_t v) const {
    Vec3 best = crossings_.at[crossing_of(v, 0)];
    for (uint32_t i = 1; i < net_.first_use[v + 1] - net_.first_use[v]; ++i) {
      const Vec3& p = crossings_.at[crossing_of(v, i)];
      if (norm(p - vertices_.at[v]) < norm(best - vertices_.at[v])) best = p;
    }
    return in_room(best, v);
  }

  // Each face gets the mean normal of its side.
  void set_normals(Batch& batch) const {
    for (size_t k = 0; k < batch.count; ++k) {
      const uint32_t v = batch.vertices[k];
      Sample* samples = &batch.samples[batch.first[k]];
      const size_t n = batch.first[k + 1] - batch.first[k];
      find_sides(samples, n);
      std::array<Vec3, 16> sum{};
      for (size_t i = 0; i < n; ++i) {
        if (samples[i].side >= 0) sum[samples[i].side] = sum[samples[i].side] + samples[i].normal;
      }
      for (uint32_t i = 0; i < n; ++i) {
        const uint32_t use = net_.uses[net_.first_use[v] + i];
        corner_normals_[use] =
            samples[i].side >= 0 ? normalized(sum[samples[i].side]) : crossings_.normal[use / 4];
      }
    }
  }

  const Field& field_;
  const Grid& grid_;
  const Net& net_;
  const CrossingPoints& crossings_;
  Vertices& vertices_;
  std::vector<Vec3>& corner_normals_;
  double slack_;  // how far a vertex may leave its room
};

}  // namespace

void place_features(const Field& field, const Grid& grid, const Net& net,
                    const CrossingPoints& crossings, Vertices& vertices,
                    std::vector<Vec3>& corner_normals, Work& work) {
  const auto place = [&](const std::vector<uint32_t>& numbers, double slack) {
    const Features features(field, grid, net, crossings, vertices, corner_normals, slack);
    work.run(numbers.size(), 32,
             [&](size_t first, size_t last) { features.place(&numbers[first], last - first); });
  };
  place(vertices.sharp, slack_in_cells);
  // Those that were taken back stay in their room, so this ends.
  for (;;) {
    const auto numbers = vertices_to_take_back(grid, net, crossings, vertices);
    if (numbers.empty()) break;
    place(numbers, 0);
  }
}

}  // namespace sardf::mesher
