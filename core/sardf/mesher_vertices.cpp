// Faces, and vertices of smooth pieces: the middle of the piece's crossings, moved onto the
// surface.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "sardf/mesher_blocks.hpp"

namespace sardf::mesher {

namespace {

// Normals of one piece that differ more than this may mean an edge: cos(15 degrees), cos(7.5).
constexpr float smooth_cosine = 0.9659f, half_smooth_cosine = 0.9915f;
// After a longer step, in cells, the gradient is taken again: it would no longer be the vertex's.
constexpr double short_step = 0.01;

// Whether the normals tell that there is no edge among them.
bool are_like(const Crossing* const* crossings, int count) {
  const auto dot3 = [](const std::array<float, 3>& a, const std::array<float, 3>& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  };
  // Normals within half of the angle from the first are within all of it from one another.
  const auto& first = crossings[0]->normal;
  float least = dot3(first, first);
  for (int i = 1; i < count; ++i) {
    const float along = dot3(first, crossings[i]->normal);
    least = along < least ? along : least;
  }
  if (least > half_smooth_cosine) return true;
  for (int i = 0; i < count; ++i) {
    const auto& a = crossings[i]->normal;
    if (!(dot3(a, a) > 0.5f)) return false;
    for (int j = 0; j < i; ++j) {
      if (dot3(a, crossings[j]->normal) < smooth_cosine) return false;
    }
  }
  return true;
}

// Where points may lie.
template <class T>
struct Rooms {
  T lo[3][Points<T>::capacity], hi[3][Points<T>::capacity];
};

// Moves n points by one step of Newton's method, not out of their rooms; the squares of the steps.
template <class T>
void newton(Points<T>& points, const Rooms<T>& rooms, size_t n, T* squares) {
  constexpr T most = std::numeric_limits<T>::max();
  for (size_t i = 0; i < n; ++i) {
    const T x = points.gradient[0][i], y = points.gradient[1][i], z = points.gradient[2][i];
    const T value = points.value[i], square = x * x + y * y + z * z;
    const bool good = (square > 0) & (square <= most) & (std::abs(value) <= most);
    const T by = good ? -value / square : T(0);
    points.value[i] = by;
    squares[i] = good ? by * by * square : T(0);
  }
  for (size_t axis = 0; axis < 3; ++axis) {
    T* at = points.xyz[axis];
    for (size_t i = 0; i < n; ++i) {
      const T by = points.value[i];
      // Where there is no step the gradient may be no number.
      const T to = by == 0 ? at[i] : at[i] + by * points.gradient[axis][i];
      const T lo = rooms.lo[axis][i], hi = rooms.hi[axis][i];
      at[i] = to < lo ? lo : to > hi ? hi : to;
    }
  }
}

// Vertices that later stages look at again.
struct Listed {
  std::vector<uint32_t> sharp, apart;
};

// The smooth vertices of one block, some at a time.
template <class T>
class SmoothVertices {
 public:
  SmoothVertices(const Field& field, const Grid& grid, Vertices& vertices, Listed& listed)
      : field_(field), grid_(grid), vertices_(vertices), listed_(listed) {}

  void begin(const Index3& block) {
    local_ = field_.local(block, block_level);
    in_parts_ = local_.program->tape().instructions().size() > long_program;
  }

  // `lo`: where corner 0 of its cell lies.
  void add(uint32_t vertex, const Vec3& at, const Vec3& lo, uint8_t sides,
           const BoundingBox& room) {
    if (count_ == numbers_.size()) move();
    for (size_t axis = 0; axis < 3; ++axis) {
      rooms_.lo[axis][count_] = T(room.lo[axis]);
      rooms_.hi[axis][count_] = T(room.hi[axis]);
    }
    points_.set(count_, at);
    cells_[count_] = {lo, sides};
    numbers_[count_++] = vertex;
  }

  // Moves them onto the surface: one step, or two where the first was long, and a last one with a
  // value in double precision. Those for which that is not enough are sharp.
  void move() {
    if (count_ == 0) return;
    differentiate(points_, count_);
    newton(points_, rooms_, count_, squares_.data());
    move_again();
    Points<double> exact;
    for (size_t axis = 0; axis < 3; ++axis) {
      std::copy_n(points_.xyz[axis], count_, exact.xyz[axis]);
    }
    evaluate(exact, count_);
    inverse_lengths(points_, count_, squares_.data());
    for (size_t i = 0; i < count_; ++i) finish(i, exact);
    count_ = 0;
  }

 private:
  struct Cell {
    Vec3 lo;
    uint8_t sides;
  };

  // A second step for those whose first was long.
  void move_again() {
    const double longest = short_step * grid_.cell;
    std::array<uint16_t, Points<T>::capacity> open;
    size_t n = 0;
    for (size_t i = 0; i < count_; ++i) {
      open[n] = uint16_t(i);
      n += double(squares_[i]) > longest * longest;
    }
    if (n == 0) return;
    Points<T> points;
    Rooms<T> rooms;
    for (size_t axis = 0; axis < 3; ++axis) {
      for (size_t k = 0; k < n; ++k) {
        points.xyz[axis][k] = points_.xyz[axis][open[k]];
        rooms.lo[axis][k] = rooms_.lo[axis][open[k]];
        rooms.hi[axis][k] = rooms_.hi[axis][open[k]];
      }
    }
    differentiate(points, n);
    newton(points, rooms, n, squares_.data());
    for (size_t axis = 0; axis < 3; ++axis) {
      for (size_t k = 0; k < n; ++k) {
        points_.xyz[axis][open[k]] = points.xyz[axis][k];
        points_.gradient[axis][open[k]] = points.gradient[axis][k];
      }
    }
  }

  // The last step, along the normal.
  void finish(size_t i, const Points<double>& exact) {
    const double inverse = double(squares_[i]), height = exact.value[i] * inverse;
    const double step = std::abs(height) < infinity ? height : 0;
    const Cell& cell = cells_[i];
    const BoundingBox room = room_of(grid_, cell.lo, cell.sides);
    std::array<float, 3> normal;
    double beyond = 0;
    bool is_inner = true;
    Vec3 placed;
    for (size_t axis = 0; axis < 3; ++axis) {
      // Where there is no normal the gradient may be no number.
      const double along = inverse > 0 ? -inverse * double(points_.gradient[axis][i]) : 0;
      const double wanted = exact.xyz[axis][i] + step * along;
      const double at = std::clamp(wanted, room.lo[axis], room.hi[axis]);
      beyond += (wanted - at) * (wanted - at);
      placed[axis] = at;
      normal[axis] = float(along);
      is_inner = is_inner && at > cell.lo[axis] && at < cell.lo[axis] + 0.999 * grid_.cell;
    }
    const double cells = 1 / (grid_.cell * grid_.cell);
    const bool found = inverse > 0 && step * step * cells < 4e-6 && beyond * cells < 1e-6;
    const uint32_t v = numbers_[i];
    vertices_.at[v] = placed;
    if (found) vertices_.normal[v] = normal;
    if (!found) {
      listed_.sharp.push_back(v);
    } else if (!is_inner) {
      listed_.apart.push_back(v);
    }
  }

  void differentiate(Points<T>& points, size_t n) const {
    in_parts_ ? field_.differentiate(points, n) : field_.differentiate(local_, points, n);
  }
  void evaluate(Points<double>& points, size_t n) const {
    in_parts_ ? field_.evaluate(points, n) : field_.evaluate(local_, points, n);
  }

  const Field& field_;
  const Grid& grid_;
  Vertices& vertices_;
  Listed& listed_;
  Field::Local local_{};
  bool in_parts_ = false;  // the parts of the block have shorter programs
  size_t count_ = 0;
  std::array<uint32_t, Points<T>::capacity> numbers_;
  std::array<Cell, Points<T>::capacity> cells_;
  std::array<T, Points<T>::capacity> squares_;  // of steps, and at last inverse lengths
  Points<T> points_;
  Rooms<T> rooms_;
};

// Where the crossings are numbered that start in the cells of a block and of those after it.
class Owners {
 public:
  static constexpr int side = block_cells + 1;

  void find(const Cells& cells, const Index3& block) {
    for (int k = 0; k < 8; ++k) {
      const std::array<int, 3> beyond{k & 1, k >> 1 & 1, k >> 2 & 1};
      const Index3 place{block[0] + beyond[0], block[1] + beyond[1], block[2] + beyond[2]};
      const auto found = cells.block_at.find(key(place));
      if (found != cells.block_at.end()) add(cells, cells.blocks[found->second], beyond);
    }
  }

  static constexpr int index(int x, int y, int z) { return x + side * (y + side * z); }

  /// The crossing along the axis from the corner 0 of the cell with that index.
  uint32_t crossing(int cell, int axis) const {
    const Owner& of = owners_[size_t(cell)];
    return of.first + (of.before >> (2 * axis) & 3);
  }

 private:
  struct Owner {
    uint32_t first;   // crossing
    uint32_t before;  // two bits for each axis: how many of the cell's crossings come before it
  };

  void add(const Cells& cells, const Cells::Block& block, const std::array<int, 3>& beyond) {
    // Of a block behind this one only the nearest layer of cells is needed.
    const uint64_t mask =
        (beyond[0] ? 0x0101010101010101u : ~uint64_t(0)) & (beyond[1] ? 0xFFu : ~uint64_t(0));
    const int first = index(8 * beyond[0], 8 * beyond[1], 8 * beyond[2]);
    for (int z = 0; z < (beyond[2] ? 1 : block_cells); ++z) {
      const uint64_t all = block.occupied[size_t(z)];
      for (uint64_t left = all & mask; left != 0; left &= left - 1) {
        const int bit = std::countr_zero(left);
        const uint64_t before = (uint64_t(1) << bit) - 1;
        const uint32_t cell = block.first[size_t(z)] + uint32_t(std::popcount(all & before));
        const int crossed = crossed_edges[cells.inside[cell]];
        const uint32_t x = crossed & 1, y = crossed >> 4 & 1;
        owners_[size_t(first + index(bit & 7, bit >> 3, z))] = {cells.first_crossing[cell],
                                                                x << 2 | (x + y) << 4};
      }
    }
  }

  std::array<Owner, side * side * side> owners_{};
};

// The crossed edges of one piece of surface in a cell.
struct PieceEdges {
  struct Edge {
    int16_t owner;  // the cell whose corner 0 it starts at, relative to this one (Owners::index)
    uint8_t axis, corner;
  };
  Vec3 starts{};  // sum of the edges' starts, in cells from corner 0
  int count = 0;
  uint8_t sides = 0;  // as Pieces::sides
  std::array<Edge, 12> edges{};

  PieceEdges(uint8_t inside, const Pieces& pieces, int piece) : sides(pieces.sides[size_t(piece)]) {
    constexpr std::array<int, 3> step{1, Owners::side, Owners::side * Owners::side};
    for (size_t k = 0; k < 12; ++k) {
      if (pieces.of_edge[k] != piece) continue;
      const EdgeOfCell& edge = edges_of_cell[k];
      const bool leaves = inside >> edge.corner & 1;
      starts[size_t(edge.e)] += edge.side_e;
      starts[size_t(edge.g)] += edge.side_g;
      const int owner = edge.side_e * step[size_t(edge.e)] + edge.side_g * step[size_t(edge.g)];
      edges[size_t(count++)] = {int16_t(owner), uint8_t(edge.axis),
                                uint8_t(leaves ? edge.face_corner : 3 - edge.face_corner)};
    }
  }
};

std::vector<PieceEdges> edges_of_pieces(uint8_t inside, uint8_t joined) {
  const Pieces pieces = pieces_of(inside, joined);
  std::vector<PieceEdges> result;
  for (int piece = 0; piece < pieces.count; ++piece) result.emplace_back(inside, pieces, piece);
  return result;
}

// Makes the faces of blocks of cells and places their vertices.
template <class T>
class BlockVertices {
 public:
  BlockVertices(const Field& field, const Grid& grid, const Cells& cells, Net& net,
                Vertices& vertices, Listed& listed)
      : grid_(grid),
        cells_(cells),
        net_(net),
        vertices_(vertices),
        listed_(listed),
        smooth_(field, grid, vertices, listed) {}

  /// The cells of one block, from `first` to `last`.
  void place(const Index3& block, uint32_t first, uint32_t last) {
    static const std::array<std::vector<PieceEdges>, 256> separated = [] {
      std::array<std::vector<PieceEdges>, 256> table;
      for (size_t i = 0; i < 256; ++i) table[i] = edges_of_pieces(uint8_t(i), 0);
      return table;
    }();
    owners_.find(cells_, block);
    smooth_.begin(block);
    for (uint32_t i = first; i < last; ++i) {
      const uint8_t inside = cells_.inside[i], joined = cells_.joined[i];
      if (joined == 0) {
        place_in_cell(i, separated[inside]);
      } else {
        place_in_cell(i, edges_of_pieces(inside, joined));
      }
    }
    smooth_.move();
  }

 private:
  void place_in_cell(uint32_t cell, const std::vector<PieceEdges>& pieces) {
    const Index3& at = cells_.at[cell];
    const int index = Owners::index(at[0] & 7, at[1] & 7, at[2] & 7);
    const Vec3 lo = grid_.point(at);
    uint32_t vertex = net_.first_vertex[cell];
    for (const PieceEdges& piece : pieces) {
      place(piece, index, lo, vertex, pieces.size() > 1);
      ++vertex;
    }
  }

  void place(const PieceEdges& piece, int index, const Vec3& lo, uint32_t vertex, bool shares) {
    Vec3 sum = piece.starts;
    std::array<const Crossing*, 12> crossings;
    for (int i = 0; i < piece.count; ++i) {
      const PieceEdges::Edge& edge = piece.edges[size_t(i)];
      const uint32_t c = owners_.crossing(index + edge.owner, edge.axis);
      net_.faces[c][edge.corner] = vertex;
      crossings[size_t(i)] = &cells_.crossings[c];
      sum[edge.axis] += double(cells_.crossings[c].at);
    }
    const BoundingBox room = room_of(grid_, lo, piece.sides);
    const Vec3 middle = clamped(lo + (grid_.cell / piece.count) * sum, room);
    if (are_like(crossings.data(), piece.count)) {
      smooth_.add(vertex, middle, lo, piece.sides, room);
      if (shares) listed_.apart.push_back(vertex);
    } else {
      vertices_.at[vertex] = middle;
      listed_.sharp.push_back(vertex);
    }
  }

  const Grid& grid_;
  const Cells& cells_;
  Net& net_;
  Vertices& vertices_;
  Listed& listed_;
  Owners owners_;
  SmoothVertices<T> smooth_;
};

constexpr size_t blocks_at_once = 8;

template <class T>
void place_in_blocks(const Field& field, const Grid& grid, const Cells& cells, Net& net,
                     Vertices& vertices, std::vector<Listed>& listed, Work& work) {
  work.run(cells.blocks.size(), blocks_at_once, [&](size_t first, size_t last) {
    Listed& list = listed[first / blocks_at_once];
    BlockVertices<T> block_vertices(field, grid, cells, net, vertices, list);
    for (size_t b = first; b < last; ++b) {
      const uint32_t end =
          b + 1 < cells.blocks.size() ? cells.blocks[b + 1].first[0] : uint32_t(cells.at.size());
      block_vertices.place(cells.blocks[b].place, cells.blocks[b].first[0], end);
    }
  });
}

void append(std::vector<uint32_t>& more, std::vector<uint32_t>& to) {
  std::sort(more.begin(), more.end());
  more.erase(std::unique(more.begin(), more.end()), more.end());
  to.insert(to.end(), more.begin(), more.end());
}

}  // namespace

Vertices place_vertices(const Field& field, const Grid& grid, const Cells& cells, Net& net,
                        Work& work) {
  const size_t count = net.vertex_count();
  Vertices vertices;
  resize_on_all_threads(vertices.at, count);
  vertices.normal.resize(count);
  resize_on_all_threads(net.faces, cells.crossings.size());
  std::vector<Listed> listed((cells.blocks.size() + blocks_at_once - 1) / blocks_at_once);
  const auto place = grid.single ? &place_in_blocks<float> : &place_in_blocks<double>;
  place(field, grid, cells, net, vertices, listed, work);
  // Vertices are numbered as their blocks.
  for (Listed& list : listed) {
    append(list.sharp, vertices.sharp);
    append(list.apart, vertices.apart);
  }
  return vertices;
}

}  // namespace sardf::mesher
