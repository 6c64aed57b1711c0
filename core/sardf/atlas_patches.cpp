// The atlas's second stage: pieces of surface that turn little, by variational shape approximation
// (Cohen-Steiner, Alliez, Desbrun 2004): patches grow in order of their faces' deviation from the
// patch's mean normal, then start again from their best faces. A share of distance keeps patches
// compact.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>

#include "sardf/atlas_stages.hpp"

namespace sardf::atlas {
namespace {

// A patch must project on a plane without folding: its normals stay well inside 90 degrees.
constexpr double grow_cosine = 0.62;  // 52 degrees while growing
constexpr double keep_cosine = 0.34;  // 70 degrees after the patches have settled
constexpr double compactness = 0.15;
constexpr int rounds = 4;
constexpr size_t faces_per_report = 4096;
constexpr int smoothing_passes = 3;
constexpr int averaging_passes = 8;

struct Patch {
  Vec3 normal{0, 0, 0};
  Vec3 centre{0, 0, 0};
  double area = 0;
  double radius_squared = 0;
  uint32_t seed = none;
};

struct Candidate {
  double cost;
  uint32_t face;
  uint32_t patch;
  bool operator>(const Candidate& other) const {
    return cost != other.cost ? cost > other.cost : face > other.face;
  }
};
using Queue = std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>>;

template <typename Visit>
void for_neighbours(const Surface& surface, uint32_t face, const Visit& visit) {
  for (uint32_t h = 4 * face; h < 4 * face + 4; ++h)
    if (surface.twin[h] != none) visit(surface.twin[h] / 4);
}

/// Faces from the flattest surroundings to the most curved ones: a patch that starts where the
/// surface is flat (a plane, the flat points of a lattice) ends where it is curved most.
std::vector<uint32_t> flattest_first(const Surface& surface) {
  const auto count = static_cast<uint32_t>(surface.face_count());
  std::vector<double> bend(count, 0), averaged(count);
  for (uint32_t f = 0; f < count; ++f)
    for_neighbours(surface, f, [&](uint32_t other) {
      const Vec3 turn = surface.normal[other] - surface.normal[f];
      bend[f] += dot(turn, turn);
    });
  for (int pass = 0; pass < averaging_passes; ++pass) {
    for (uint32_t f = 0; f < count; ++f) {
      double sum = bend[f], shares = 1;
      for_neighbours(surface, f, [&](uint32_t other) {
        sum += bend[other];
        ++shares;
      });
      averaged[f] = sum / shares;
    }
    bend.swap(averaged);
  }
  std::vector<uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](uint32_t a, uint32_t b) { return bend[a] < bend[b]; });
  return order;
}

/// Grows new patches over all faces without one, each until its normals have turned too far.
void grow(const Surface& surface, const std::vector<uint32_t>& order,
          std::vector<uint32_t>& patch_of_face, uint32_t& patch_count, const Report& report) {
  for (const uint32_t start : order) {
    if (patch_of_face[start] != none) continue;
    const uint32_t patch = patch_count++;
    const Vec3& normal = surface.normal[start];
    Queue queue;
    queue.push({0, start, patch});
    for (size_t popped = 0; !queue.empty(); ++popped) {
      if (popped % faces_per_report == 0) report();
      const uint32_t face = queue.top().face;
      queue.pop();
      if (patch_of_face[face] != none) continue;
      patch_of_face[face] = patch;
      for_neighbours(surface, face, [&](uint32_t other) {
        const double cosine = dot(normal, surface.normal[other]);
        if (patch_of_face[other] == none && cosine > grow_cosine)
          queue.push({1 - cosine, other, patch});
      });
    }
  }
}

double cost(const Surface& surface, const Patch& patch, uint32_t face) {
  const Vec3 turn = surface.normal[face] - patch.normal;
  const Vec3 way = surface.centre[face] - patch.centre;
  return dot(turn, turn) + compactness * dot(way, way) / (patch.radius_squared + 1e-300);
}

std::vector<Patch> describe(const Surface& surface, const std::vector<uint32_t>& patch_of_face,
                            uint32_t patch_count) {
  std::vector<Patch> patches(patch_count);
  for (size_t f = 0; f < patch_of_face.size(); ++f) {
    Patch& patch = patches[patch_of_face[f]];
    const double area = surface.area[f] + 1e-300;
    patch.area += area;
    patch.normal = patch.normal + area * surface.normal[f];
    patch.centre = patch.centre + area * surface.centre[f];
  }
  for (Patch& patch : patches) {
    if (patch.area == 0) continue;
    patch.centre = (1 / patch.area) * patch.centre;
    const double length = norm(patch.normal);
    if (length > 0) patch.normal = (1 / length) * patch.normal;
  }
  for (size_t f = 0; f < patch_of_face.size(); ++f) {
    Patch& patch = patches[patch_of_face[f]];
    const Vec3 way = surface.centre[f] - patch.centre;
    patch.radius_squared += 2 * dot(way, way) * surface.area[f] / patch.area;
  }
  std::vector<double> best(patch_count, INFINITY);
  for (uint32_t f = 0; f < patch_of_face.size(); ++f) {
    const uint32_t p = patch_of_face[f];
    const double value = cost(surface, patches[p], f);
    if (value < best[p]) {
      best[p] = value;
      patches[p].seed = f;
    }
  }
  return patches;
}

void flood(const Surface& surface, const std::vector<Patch>& patches,
           std::vector<uint32_t>& patch_of_face, const Report& report) {
  Queue queue;
  std::fill(patch_of_face.begin(), patch_of_face.end(), none);
  for (uint32_t p = 0; p < patches.size(); ++p)
    if (patches[p].seed != none) queue.push({0, patches[p].seed, p});
  for (size_t popped = 0; !queue.empty(); ++popped) {
    if (popped % faces_per_report == 0) report();
    const auto [value, face, p] = queue.top();
    queue.pop();
    if (patch_of_face[face] != none) continue;
    if (dot(surface.normal[face], patches[p].normal) < keep_cosine) continue;
    patch_of_face[face] = p;
    for_neighbours(surface, face, [&](uint32_t other) {
      if (patch_of_face[other] == none) queue.push({cost(surface, patches[p], other), other, p});
    });
  }
}

/// Straightens borders: a face with three or more neighbours in another patch goes there.
void smooth(const Surface& surface, const std::vector<Patch>& patches,
            std::vector<uint32_t>& patch_of_face) {
  for (int pass = 0; pass < smoothing_passes; ++pass)
    for (uint32_t f = 0; f < patch_of_face.size(); ++f) {
      std::array<uint32_t, 4> around{none, none, none, none};
      size_t count = 0;
      for_neighbours(surface, f, [&](uint32_t other) { around[count++] = patch_of_face[other]; });
      for (size_t i = 0; i < count; ++i)
        if (around[i] != patch_of_face[f] &&
            std::count(around.begin(), around.end(), around[i]) > 2 &&
            dot(surface.normal[f], patches[around[i]].normal) > keep_cosine)
          patch_of_face[f] = around[i];
    }
}

}  // namespace

std::vector<uint32_t> cut_patches(const Surface& surface, const Report& report) {
  std::vector<uint32_t> patch_of_face(surface.face_count(), none);
  const std::vector<uint32_t> order = flattest_first(surface);
  uint32_t count = 0;
  grow(surface, order, patch_of_face, count, report);
  for (int round = 0; round < rounds; ++round) {
    flood(surface, describe(surface, patch_of_face, count), patch_of_face, report);
    grow(surface, order, patch_of_face, count, report);
  }
  smooth(surface, describe(surface, patch_of_face, count), patch_of_face);
  return patch_of_face;
}

}  // namespace sardf::atlas
