// How the surface is connected: pieces of surface in each cell, vertices and faces.
//
// A face of a cell with two inside corners across from each other is ambiguous. Where both cells at
// it would have one piece that meets the face twice, the mesh would get an edge with four faces;
// resolving the face the other way splits the piece in both cells and never joins any.
#include <algorithm>
#include <numeric>

#include "sardf/mesher_stages.hpp"

namespace sardf::mesher {

namespace {

constexpr int edge_number(int axis, int side_e, int side_g) {
  return 4 * axis + side_e + 2 * side_g;
}

/// The edge of a cell along `axis` through corner c.
constexpr int edge_at(int axis, int c) {
  return edge_number(axis, c >> (axis + 1) % 3 & 1, c >> (axis + 2) % 3 & 1);
}

// Sets of edges that one piece of surface crosses.
class EdgeSets {
 public:
  EdgeSets() {
    for (int8_t i = 0; i < 12; ++i) parent_[i] = i;
  }
  int8_t root(int edge) const {
    int8_t r = int8_t(edge);
    while (parent_[r] != r) r = parent_[r];
    return r;
  }
  void join(int a, int b) {
    const int8_t p = root(a), q = root(b);
    parent_[std::max(p, q)] = std::min(p, q);
  }

 private:
  std::array<int8_t, 12> parent_;
};

// Joins the edges of one face that the surface connects within the face.
void connect_face(uint8_t inside, int axis, int s, bool joined, EdgeSets& sets) {
  const int ea = (axis + 1) % 3, ga = (axis + 2) % 3;
  const int corners[4] = {s << axis, s << axis | 1 << ea, s << axis | 1 << ea | 1 << ga,
                          s << axis | 1 << ga};
  if (is_ambiguous(inside, axis, s)) {
    // Each inside corner is cut off, or each outside corner where the inside ones are joined.
    for (const int c : corners) {
      if ((inside >> c & 1) != int(joined)) sets.join(edge_at(ea, c), edge_at(ga, c));
    }
    return;
  }
  int first = -1;
  for (int k = 0; k < 4; ++k) {
    const int c = corners[k], next = corners[(k + 1) % 4];
    if ((inside >> c & 1) == (inside >> next & 1)) continue;
    const int edge = edge_at(k % 2 == 0 ? ea : ga, c);
    if (first < 0) {
      first = edge;
    } else {
      sets.join(first, edge);
    }
  }
}

Pieces find_pieces(uint8_t inside, uint8_t joined) {
  EdgeSets sets;
  for (int face = 0; face < 6; ++face) {
    connect_face(inside, face / 2, face % 2, joined >> face & 1, sets);
  }
  Pieces pieces{{}, 0, {}};
  std::array<int8_t, 12> number;
  number.fill(-1);
  const uint16_t crossed = crossed_edges[inside];
  for (int k = 0; k < 12; ++k) {
    pieces.of_edge[k] = -1;
    if (!(crossed >> k & 1)) continue;
    int8_t& n = number[sets.root(k)];
    if (n < 0) n = int8_t(pieces.count++);
    pieces.of_edge[k] = n;
    const EdgeOfCell& edge = edges_of_cell[k];
    pieces.sides[n] |= uint8_t(1 << (2 * edge.e + edge.side_e) | 1 << (2 * edge.g + edge.side_g));
  }
  return pieces;
}

// Whether one piece meets the ambiguous face twice.
bool meets_twice(const Pieces& pieces, int axis, int s) {
  const int ea = (axis + 1) % 3, ga = (axis + 2) % 3, c = s << axis;
  const int8_t piece = pieces.of_edge[edge_at(ea, c)];
  return pieces.of_edge[edge_at(ea, c | 1 << ga)] == piece &&
         pieces.of_edge[edge_at(ga, c)] == piece &&
         pieces.of_edge[edge_at(ga, c | 1 << ea)] == piece;
}

void settle_ambiguous_faces(Cells& cells) {
  CellFinder find(cells);
  for (uint32_t i = 0; i < cells.at.size(); ++i) {
    if (!has_ambiguous_face[cells.inside[i]]) continue;
    for (int axis = 0; axis < 3; ++axis) {
      if (!is_ambiguous(cells.inside[i], axis, 1)) continue;
      Index3 next = cells.at[i];
      ++next[axis];
      const uint32_t j = find(next);
      const uint8_t upper = uint8_t(2 << 2 * axis), lower = uint8_t(1 << 2 * axis);
      const bool joined = cells.joined[i] & upper;
      cells.joined[j] = uint8_t(joined ? cells.joined[j] | lower : cells.joined[j] & ~lower);
      if (meets_twice(pieces_of(cells.inside[i], cells.joined[i]), axis, 1) &&
          meets_twice(pieces_of(cells.inside[j], cells.joined[j]), axis, 0)) {
        cells.joined[i] ^= upper;
        cells.joined[j] ^= lower;
      }
    }
  }
}

}  // namespace

Pieces pieces_of(uint8_t inside, uint8_t joined) {
  static const std::array<Pieces, 256> separated = [] {
    std::array<Pieces, 256> table;
    for (int i = 0; i < 256; ++i) table[i] = find_pieces(uint8_t(i), 0);
    return table;
  }();
  return joined == 0 ? separated[inside] : find_pieces(inside, joined);
}

Net build_net(Cells& cells, Work& work) {
  settle_ambiguous_faces(cells);
  Net net;
  net.first_vertex.resize(cells.at.size());
  constexpr size_t grain = 4096;
  std::vector<uint32_t> begin(cells.at.size() / grain + 2);  // vertices before each part
  work.run(cells.at.size(), grain, [&](size_t first, size_t last) {
    uint32_t& count = begin[first / grain + 1];
    for (size_t i = first; i < last; ++i)
      count += uint32_t(pieces_of(cells.inside[i], cells.joined[i]).count);
  });
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  net.cell.resize(begin.back());
  net.sides.resize(begin.back());
  work.run(cells.at.size(), grain, [&](size_t first, size_t last) {
    uint32_t v = begin[first / grain];
    for (size_t i = first; i < last; ++i) {
      const Pieces pieces = pieces_of(cells.inside[i], cells.joined[i]);
      net.first_vertex[i] = v;
      for (int piece = 0; piece < pieces.count; ++piece, ++v) {
        net.cell[v] = uint32_t(i);
        net.sides[v] = pieces.sides[size_t(piece)];
      }
    }
  });
  return net;
}

BoundingBox Places::room(uint32_t vertex) const {
  return room_of(grid_, grid_.point(cells_.at[net_.cell[vertex]]), net_.sides[vertex]);
}

BoundingBox Places::cell_box(uint32_t vertex) const {
  const Index3& cell = cells_.at[net_.cell[vertex]];
  return {grid_.point(cell), grid_.point({cell[0] + 1, cell[1] + 1, cell[2] + 1})};
}

bool Places::is_in_cell(uint32_t vertex, const Vec3& point) const {
  const BoundingBox cell = cell_box(vertex);
  for (int axis = 0; axis < 3; ++axis) {
    if (point[axis] < cell.lo[axis] || point[axis] > cell.hi[axis]) return false;
  }
  return true;
}

Uses Places::uses(uint32_t vertex) const {
  const uint32_t cell = net_.cell[vertex];
  const uint8_t inside = cells_.inside[cell];
  const int piece = int(vertex - net_.first_vertex[cell]);
  const Pieces pieces = pieces_of(inside, cells_.joined[cell]);
  CellFinder find(cells_);
  Uses uses;
  for (int k = 0; k < 12; ++k) {
    if (pieces.of_edge[size_t(k)] != piece) continue;
    const EdgeOfCell& edge = edges_of_cell[size_t(k)];
    const bool leaves = inside >> edge.corner & 1;
    const int corner = leaves ? edge.face_corner : 3 - edge.face_corner;
    Index3 at = cells_.at[cell];
    at[edge.e] += edge.side_e;
    at[edge.g] += edge.side_g;
    const uint32_t owner = edge.corner == 0 ? cell : find(at);
    uses.at[uses.count++] = 4 * crossing_at(cells_, owner, edge.axis) + uint32_t(corner);
  }
  std::sort(uses.at.begin(), uses.at.begin() + uses.count);
  return uses;
}

Vec3 Places::normal(uint32_t c) const {
  const auto& n = cells_.crossings[c].normal;
  const Vec3 normal{n[0], n[1], n[2]};
  // As exact as doubles are.
  return dot(normal, normal) > 0.5 ? normalized(normal) : Vec3{0, 0, 0};
}

}  // namespace sardf::mesher
