// How the surface is connected: pieces of surface in each cell, vertices and faces.
//
// A face of a cell with two inside corners across from each other is ambiguous. Where both cells at
// it would have one piece that meets the face twice, the mesh would get an edge with four faces;
// resolving the face the other way splits the piece in both cells and never joins any.
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

bool is_ambiguous(uint8_t inside, int axis, int s) {
  const int e = 1 << (axis + 1) % 3, g = 1 << (axis + 2) % 3, c = s << axis;
  const auto at = [&](int k) { return inside >> k & 1; };
  return at(c) == at(c + e + g) && at(c + e) == at(c + g) && at(c) != at(c + e);
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
  Pieces pieces{{}, 0};
  std::array<int8_t, 12> number;
  number.fill(-1);
  for (int edge = 0; edge < 12; ++edge) {
    const int axis = edge / 4;
    const int c = (edge & 1) << (axis + 1) % 3 | (edge >> 1 & 1) << (axis + 2) % 3;
    pieces.of_edge[edge] = -1;
    if ((inside >> c & 1) == (inside >> (c | 1 << axis) & 1)) continue;
    int8_t& n = number[sets.root(edge)];
    if (n < 0) n = int8_t(pieces.count++);
    pieces.of_edge[edge] = n;
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

// Where the vertex of a piece may lie. A face's four vertices lie in the four quadrants around its
// grid edge, so that the face, seen along the edge, is a simple polygon that is not turned over:
// the piece's edges at a side of the cell keep the vertex from passing that side. Past a side
// without such an edge the vertex may follow the tip of a ridge that pokes out of the cell.
BoundingBox room_of(const Pieces& pieces, int piece, const Vec3& lo, double cell) {
  constexpr double margin = 1e-4;
  BoundingBox room;
  for (int axis = 0; axis < 3; ++axis) {
    room.lo[axis] = lo[axis] - cell;
    room.hi[axis] = lo[axis] + 2 * cell;
  }
  for (int edge = 0; edge < 12; ++edge) {
    if (pieces.of_edge[edge] != piece) continue;
    for (int k = 0; k < 2; ++k) {
      const int axis = (edge / 4 + 1 + k) % 3;
      if (edge >> k & 1) {
        room.hi[axis] = lo[axis] + (1 - margin) * cell;
      } else {
        room.lo[axis] = lo[axis] + margin * cell;
      }
    }
  }
  return room;
}

void make_vertices(const Cells& cells, const Grid& grid, Net& net,
                   std::vector<uint32_t>& first_vertex, Work& work) {
  first_vertex.resize(cells.at.size());
  uint32_t count = 0;
  for (size_t i = 0; i < cells.at.size(); ++i) {
    first_vertex[i] = count;
    count += uint32_t(pieces_of(cells.inside[i], cells.joined[i]).count);
  }
  net.cell.resize(count);
  net.room.resize(count);
  work.run(cells.at.size(), 4096, [&](size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) {
      const Pieces pieces = pieces_of(cells.inside[i], cells.joined[i]);
      const Vec3 lo = grid.point(cells.at[i]);
      for (int piece = 0; piece < pieces.count; ++piece) {
        const size_t v = first_vertex[i] + size_t(piece);
        net.cell[v] = uint32_t(i);
        net.room[v] = room_of(pieces, piece, lo, grid.cell);
      }
    }
  });
}

std::array<uint32_t, 4> make_face(const Cells& cells, const std::vector<uint32_t>& first_vertex,
                                  const Crossing& crossing, CellFinder& find) {
  // Counter-clockwise seen from the end of the edge: sides of the edge in its four cells.
  constexpr int sides[4][2] = {{1, 1}, {0, 1}, {0, 0}, {1, 0}};
  const int axis = crossing.axis, e = (axis + 1) % 3, g = (axis + 2) % 3;
  std::array<uint32_t, 4> face;
  for (int k = 0; k < 4; ++k) {
    Index3 at = crossing.at;
    at[e] -= sides[k][0];
    at[g] -= sides[k][1];
    const uint32_t cell = find(at);
    const int edge = edge_number(axis, sides[k][0], sides[k][1]);
    const int8_t piece = pieces_of(cells.inside[cell], cells.joined[cell]).of_edge[edge];
    face[crossing.leaves ? k : 3 - k] = first_vertex[cell] + uint32_t(piece);
  }
  return face;
}

void collect_uses(Net& net) {
  net.first_use.assign(net.vertex_count() + 1, 0);
  for (const auto& face : net.faces) {
    for (const uint32_t v : face) ++net.first_use[v + 1];
  }
  for (size_t v = 0; v < net.vertex_count(); ++v) net.first_use[v + 1] += net.first_use[v];
  net.uses.resize(4 * net.faces.size());
  std::vector<uint32_t> next(net.first_use.begin(), net.first_use.end() - 1);
  for (uint32_t use = 0; use < net.uses.size(); ++use) {
    net.uses[next[net.faces[use / 4][use % 4]]++] = use;
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

Net build_net(Cells& cells, const Grid& grid, Work& work) {
  settle_ambiguous_faces(cells);
  Net net;
  std::vector<uint32_t> first_vertex;
  make_vertices(cells, grid, net, first_vertex, work);
  net.faces.resize(cells.crossings.size());
  net.direction.resize(cells.crossings.size());
  work.run(net.faces.size(), 4096, [&](size_t first, size_t last) {
    CellFinder find(cells);
    for (size_t i = first; i < last; ++i) {
      const Crossing& crossing = cells.crossings[i];
      net.faces[i] = make_face(cells, first_vertex, crossing, find);
      net.direction[i] = int8_t(crossing.leaves ? crossing.axis + 1 : -crossing.axis - 1);
    }
  });
  collect_uses(net);
  return net;
}

}  // namespace sardf::mesher
