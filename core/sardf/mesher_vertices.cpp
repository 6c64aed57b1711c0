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

// The crossings around the vertex of one piece.
struct Around {
  Vec3 sum{};  // of the crossings, in cells from corner 0
  std::array<const Crossing*, 12> crossings;
  int count = 0;

  void add(const Crossing& crossing, const EdgeOfCell& edge) {
    sum[size_t(edge.axis)] += double(crossing.at);
    sum[size_t(edge.e)] += edge.side_e;
    sum[size_t(edge.g)] += edge.side_g;
    crossings[size_t(count++)] = &crossing;
  }

  bool is_smooth() const {
    const auto dot3 = [](const std::array<float, 3>& a, const std::array<float, 3>& b) {
      return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    };
    // Normals within half of the angle from the first are within all of it from one another.
    const auto& first = crossings[0]->normal;
    float least = dot3(first, first);
    for (int i = 1; i < count; ++i) {
      const float along = dot3(first, crossings[size_t(i)]->normal);
      least = along < least ? along : least;
    }
    if (least > half_smooth_cosine) return true;
    for (int i = 0; i < count; ++i) {
      const auto& a = crossings[size_t(i)]->normal;
      if (!(dot3(a, a) > 0.5f)) return false;
      for (int j = 0; j < i; ++j) {
        if (dot3(a, crossings[size_t(j)]->normal) < smooth_cosine) return false;
      }
    }
    return true;
  }
};

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

// The smooth vertices of one block, some at a time.
template <class T>
class SmoothVertices {
 public:
  SmoothVertices(const Field& field, const Grid& grid, const Cells& cells, const Net& net,
                 Vertices& vertices)
      : field_(field), grid_(grid), cells_(cells), net_(net), vertices_(vertices) {}

  void begin(const Index3& block) {
    local_ = field_.local(block, block_level);
    in_parts_ = local_.program->tape().instructions().size() > long_program;
  }

  void add(uint32_t vertex, const Vec3& at) {
    if (count_ == numbers_.size()) move();
    const BoundingBox room = room_of(vertex);
    for (size_t axis = 0; axis < 3; ++axis) {
      rooms_.lo[axis][count_] = T(room.lo[axis]);
      rooms_.hi[axis][count_] = T(room.hi[axis]);
    }
    points_.set(count_, at);
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
    for (size_t i = 0; i < count_; ++i) finish(i, exact);
    count_ = 0;
  }

 private:
  BoundingBox room_of(uint32_t v) const {
    return mesher::room_of(grid_, cells_.at[net_.cell[v]], net_.sides[v]);
  }

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

  void finish(size_t i, const Points<double>& exact) {
    const uint32_t v = numbers_[i];
    const Vec3 gradient = points_.gradient_at(i), step = newton_step(exact.value[i], gradient);
    const Vec3 wanted = Vec3{exact.xyz[0][i], exact.xyz[1][i], exact.xyz[2][i]} + step;
    const Vec3 placed = clamped(wanted, room_of(v)), beyond = wanted - placed;
    const Vec3 normal = outward_normal(gradient);
    const double cells = 1 / (grid_.cell * grid_.cell);
    const bool found = dot(step, step) * cells < 4e-6 && dot(beyond, beyond) * cells < 1e-6 &&
                       dot(normal, normal) > 0.5;
    vertices_.at[v] = placed;
    vertices_.normal[v] = normal;
    vertices_.is_sharp[v] = !found;
  }

  void differentiate(Points<T>& points, size_t n) const {
    in_parts_ ? field_.differentiate(points, n) : field_.differentiate(local_, points, n);
  }
  void evaluate(Points<double>& points, size_t n) const {
    in_parts_ ? field_.evaluate(points, n) : field_.evaluate(local_, points, n);
  }

  const Field& field_;
  const Grid& grid_;
  const Cells& cells_;
  const Net& net_;
  Vertices& vertices_;
  Field::Local local_{};
  bool in_parts_ = false;  // the parts of the block have shorter programs
  size_t count_ = 0;
  std::array<uint32_t, Points<T>::capacity> numbers_;
  std::array<T, Points<T>::capacity> squares_;
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

  /// The crossing on an edge of the cell with that index.
  uint32_t crossing(int cell, const EdgeOfCell& edge) const {
    constexpr std::array<int, 3> step{1, side, side * side};
    const int owner =
        cell + edge.side_e * step[size_t(edge.e)] + edge.side_g * step[size_t(edge.g)];
    const Owner& of = owners_[size_t(owner)];
    return of.first + (of.before >> (2 * edge.axis) & 3);
  }

 private:
  struct Owner {
    uint32_t first;   // crossing
    uint32_t before;  // two bits for each axis: how many of the cell's crossings come before it
  };

  void add(const Cells& cells, const Cells::Block& block, const std::array<int, 3>& beyond) {
    const uint64_t mask =
        (beyond[0] ? 0x0101010101010101u : ~uint64_t(0)) & (beyond[1] ? 0xFFu : ~uint64_t(0));
    for (int z = 0; z < (beyond[2] ? 1 : block_cells); ++z) {
      const uint64_t all = block.occupied[size_t(z)];
      uint32_t cell = block.first[size_t(z)];
      for (uint64_t left = all; left != 0; left &= left - 1, ++cell) {
        const int bit = std::countr_zero(left);
        if (!(mask >> bit & 1)) continue;
        const int crossed = crossed_edges[cells.inside[cell]];
        const uint32_t x = crossed & 1, y = crossed >> 4 & 1;
        const int at =
            index((bit & 7) + 8 * beyond[0], (bit >> 3) + 8 * beyond[1], z + 8 * beyond[2]);
        owners_[size_t(at)] = {cells.first_crossing[cell], x << 2 | (x + y) << 4};
      }
    }
  }

  std::array<Owner, side * side * side> owners_{};
};

// Makes the faces of blocks of cells and places their vertices.
template <class T>
class BlockVertices {
 public:
  BlockVertices(const Field& field, const Grid& grid, const Cells& cells, Net& net,
                Vertices& vertices)
      : grid_(grid),
        cells_(cells),
        net_(net),
        vertices_(vertices),
        smooth_(field, grid, cells, net, vertices) {}

  /// The cells of one block, from `first` to `last`.
  void place(const Index3& block, uint32_t first, uint32_t last) {
    owners_.find(cells_, block);
    smooth_.begin(block);
    for (uint32_t i = first; i < last; ++i) place_in_cell(i);
    smooth_.move();
  }

 private:
  void place_in_cell(uint32_t cell) {
    const uint8_t inside = cells_.inside[cell];
    const Pieces pieces = pieces_of(inside, cells_.joined[cell]);
    const Index3& at = cells_.at[cell];
    const int index = Owners::index(at[0] & 7, at[1] & 7, at[2] & 7);
    std::array<Around, 4> around;
    for (int left = crossed_edges[inside]; left != 0; left &= left - 1) {
      const size_t k = size_t(std::countr_zero(unsigned(left)));
      const EdgeOfCell& edge = edges_of_cell[k];
      const uint32_t c = owners_.crossing(index, edge);
      const size_t piece = size_t(pieces.of_edge[k]);
      const bool leaves = inside >> edge.corner & 1;
      net_.faces[c][size_t(leaves ? edge.face_corner : 3 - edge.face_corner)] =
          net_.first_vertex[cell] + uint32_t(piece);
      around[piece].add(cells_.crossings[c], edge);
    }
    const Vec3 lo = grid_.point(at);
    for (int piece = 0; piece < pieces.count; ++piece) {
      const uint32_t v = net_.first_vertex[cell] + uint32_t(piece);
      const Around& all = around[size_t(piece)];
      const Vec3 middle =
          clamped(lo + (grid_.cell / all.count) * all.sum, room_of(grid_, at, net_.sides[v]));
      if (all.is_smooth()) {
        smooth_.add(v, middle);
      } else {
        vertices_.at[v] = middle;
        vertices_.is_sharp[v] = true;
      }
    }
  }

  const Grid& grid_;
  const Cells& cells_;
  Net& net_;
  Vertices& vertices_;
  Owners owners_;
  SmoothVertices<T> smooth_;
};

template <class T>
void place_in_blocks(const Field& field, const Grid& grid, const Cells& cells, Net& net,
                     Vertices& vertices, Work& work) {
  work.run(cells.blocks.size(), 4, [&](size_t first, size_t last) {
    BlockVertices<T> block_vertices(field, grid, cells, net, vertices);
    for (size_t b = first; b < last; ++b) {
      const uint32_t end =
          b + 1 < cells.blocks.size() ? cells.blocks[b + 1].first[0] : uint32_t(cells.at.size());
      block_vertices.place(cells.blocks[b].place, cells.blocks[b].first[0], end);
    }
  });
}

}  // namespace

Vertices place_vertices(const Field& field, const Grid& grid, const Cells& cells, Net& net,
                        Work& work) {
  const size_t count = net.vertex_count();
  Vertices vertices;
  resize_large(vertices.at, count);
  vertices.normal.resize(count);
  vertices.is_sharp.resize(count);
  resize_large(net.faces, cells.crossings.size());
  const auto place = grid.single ? &place_in_blocks<float> : &place_in_blocks<double>;
  place(field, grid, cells, net, vertices, work);
  for (uint32_t v = 0; v < count; ++v) {
    if (vertices.is_sharp[v]) vertices.sharp.push_back(v);
  }
  return vertices;
}

}  // namespace sardf::mesher
