#include "sardf/mesh_topology.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>

#include "sardf/short_number.hpp"

namespace sardf {

namespace {

/// The half-edges of each vertex, one vertex after the other.
struct VertexLists {
  std::vector<size_t> first;
  std::vector<uint32_t> half_edges;

  /// `vertex_of`: a half-edge's vertex.
  template <class VertexOf>
  VertexLists(size_t vertices, size_t count, Pulse& pulse, const VertexOf& vertex_of)
      : first(vertices + 1) {
    for (uint32_t h = 0; h < count; ++h) {
      pulse.step(h, 2 * count);
      ++first[vertex_of(h) + 1];
    }
    for (size_t v = 0; v < vertices; ++v) first[v + 1] += first[v];
    std::vector<size_t> at(first.begin(), first.end() - 1);
    half_edges.resize(count);
    for (uint32_t h = 0; h < count; ++h) {
      pulse.step(count + h, 2 * count);
      half_edges[at[vertex_of(h)]++] = h;
    }
  }
  std::span<uint32_t> of(size_t v) { return {&half_edges[0] + first[v], first[v + 1] - first[v]}; }
};

constexpr size_t grain = 4096;

template <class Body>
void for_all(size_t n, Pulse& pulse, const Body& body) {
  tbb::this_task_arena::isolate([&] {
    tbb::parallel_for(size_t(0), (n + grain - 1) / grain, [&](size_t part) {
      pulse(double(part * grain) / double(n));
      for (size_t i = part * grain; i < std::min(n, (part + 1) * grain); ++i) body(i);
    });
  });
}

}  // namespace

uint32_t MeshTopology::start(uint32_t h) const { return tree_.triangles()[h / 3].corners[h % 3]; }

MeshTopology::MeshTopology(const TriangleTree& tree, Pulse& pulse)
    : tree_(tree), twins_(3 * tree.triangles().size(), none) {
  const auto smaller_end = [&](uint32_t h) { return std::min(start(h), start(next_half_edge(h))); };
  VertexLists lists(tree.vertices().size(), twins_.size(), pulse, smaller_end);
  std::atomic<bool> open{false};
  for_all(tree.vertices().size(), pulse, [&](size_t v) {
    const std::span<uint32_t> all = lists.of(v);
    const auto other_end = [&](uint32_t h) { return start(h) ^ start(next_half_edge(h)); };
    std::sort(all.begin(), all.end(), [&](uint32_t g, uint32_t h) {
      return std::pair(other_end(g), g) < std::pair(other_end(h), h);
    });
    for (size_t i = 0; i < all.size();) {
      size_t end = i;
      long net = 0;
      for (; end < all.size() && other_end(all[end]) == other_end(all[i]); ++end) {
        net += start(all[end]) == v ? 1 : -1;
      }
      // An edge from a corner to itself bounds nothing.
      if (other_end(all[i]) == 0) net = 0;
      if (net != 0) open = true;
      if (end - i == 2 && net == 0 && other_end(all[i]) != 0) {
        twins_[all[i]] = all[i + 1];
        twins_[all[i + 1]] = all[i];
      }
      i = end;
    }
  });
  closed_ = !open;
}

std::string MeshTopology::edge_fault(uint32_t half_edge) const {
  const uint32_t a = start(half_edge), b = start(next_half_edge(half_edge));
  size_t along = 0, back = 0;
  for (uint32_t h = 0; h < twins_.size(); ++h) {
    const uint32_t from = start(h), to = start(next_half_edge(h));
    along += from == a && to == b;
    back += from == b && to == a;
  }
  const auto place = [&](uint32_t v) {
    return short_point(tree_.from_local(tree_.vertices()[v]).data());
  };
  return "has an edge, from " + place(a) + " to " + place(b) + ", along which " +
         std::to_string(along) + (along == 1 ? " triangle runs" : " triangles run") + " and " +
         std::to_string(back) + " back";
}

std::optional<MeshTopology::Fault> MeshTopology::fault(Pulse& pulse) const {
  const std::vector<TriangleTree::Triangle>& triangles = tree_.triangles();
  std::vector<uint8_t> several_fans(tree_.vertices().size());
  VertexLists around(several_fans.size(), twins_.size(), pulse,
                     [&](uint32_t h) { return start(h); });
  for_all(several_fans.size(), pulse, [&](size_t v) {
    const std::span<const uint32_t> all = around.of(v);
    uint32_t h = all[0];
    size_t walked = 0;
    do {
      // Around the vertex: back over the edge that ends here.
      h = twins_[next_half_edge(next_half_edge(h))];
      ++walked;
    } while (h != none && h != all[0]);
    several_fans[v] = h == none || walked != all.size();
  });
  // A triangle without area spoils its neighbours' edges, so it is named first.
  const auto rank = [&](uint32_t t) {
    return std::pair(tree_.has_area(triangles[t]), triangles[t].given());
  };
  uint32_t worst = none;
  for (uint32_t h = 0; h < twins_.size(); ++h) {
    pulse.step(h, twins_.size());
    const uint32_t t = h / 3;
    const bool bad = twins_[h] == none || several_fans[start(h)] || !tree_.has_area(triangles[t]);
    if (bad && (worst == none || rank(t) < rank(worst / 3))) worst = h;
  }
  if (worst == none) return std::nullopt;
  const uint32_t triangle = worst / 3;
  if (!tree_.has_area(triangles[triangle])) return Fault{"has no area", triangle};
  for (uint32_t h = 3 * triangle; h < 3 * triangle + 3; ++h) {
    if (twins_[h] == none) return Fault{edge_fault(h), triangle};
  }
  return Fault{"has a corner, " +
                   short_point(tree_.from_local(tree_.vertices()[start(worst)]).data()) +
                   ", where several fans of faces meet",
               triangle};
}

std::vector<uint32_t> MeshTopology::parts(Pulse& pulse) const {
  std::vector<uint32_t> found, queue;
  std::vector<bool> seen(tree_.triangles().size());
  size_t done = 0;
  for (uint32_t first = 0; first < seen.size(); ++first) {
    pulse.step(first, seen.size());
    if (seen[first]) continue;
    found.push_back(first);
    seen[first] = true;
    queue.push_back(first);
    while (!queue.empty()) {
      const uint32_t t = queue.back();
      queue.pop_back();
      pulse.step(++done, seen.size());
      for (uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
        if (twins_[h] == none || seen[twins_[h] / 3]) continue;
        seen[twins_[h] / 3] = true;
        queue.push_back(twins_[h] / 3);
      }
    }
  }
  return found;
}

std::vector<Vec3> vertex_pseudonormals(const TriangleTree& tree, Pulse& pulse) {
  const std::vector<TriangleTree::Triangle>& triangles = tree.triangles();
  const auto start = [&](uint32_t h) { return triangles[h / 3].corners[h % 3]; };
  VertexLists around(tree.vertices().size(), 3 * triangles.size(), pulse, start);
  std::vector<Vec3> normals(tree.vertices().size());
  for_all(normals.size(), pulse, [&](size_t v) {
    for (const uint32_t h : around.of(v)) {
      const TriangleTree::Triangle& t = triangles[h / 3];
      const Vec3 &at = tree.corner(t, h % 3), to_next = tree.corner(t, (h + 1) % 3) - at,
                 to_last = tree.corner(t, (h + 2) % 3) - at, area = cross(to_next, to_last);
      const double length = std::sqrt(dot(area, area));
      if (length > 0) {
        normals[v] = normals[v] + (std::atan2(length, dot(to_next, to_last)) / length) * area;
      }
    }
  });
  return normals;
}

}  // namespace sardf
