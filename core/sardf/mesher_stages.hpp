// Shared by the stages of the mesher, in their order: blocks, cells and their crossings, net,
// vertices, features, unfold, touching, normals, creases, diagonals. Private to
// core/sardf/mesher*.cpp.
//
// Corner c of a cell lies at (c & 1, c >> 1 & 1, c >> 2 & 1). An edge along axis d, with the other
// two axes e = (d + 1) % 3 and g = (d + 2) % 3, is number 4 d + (side in e) + 2 (side in g).
#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "sardf/mesh.hpp"
#include "sardf/mesher_field.hpp"
#include "sardf/work.hpp"
#include "sardf/zeroed_memory.hpp"

namespace sardf::mesher {

/// Large arrays that begin as zeros.
template <class T>
using Large = std::vector<T, ZeroedMemory<T>>;

/// Cells along the edge of a block.
inline constexpr int block_cells = 8;

struct Grid {
  Vec3 origin{};
  double cell = 0;     // edge length of a cell
  Index3 blocks{};     // number of blocks by axis
  bool single = true;  // single precision resolves a thousandth of a cell

  double coordinate(int axis, int32_t i) const { return origin[axis] + i * cell; }
  Vec3 point(const Index3& at) const {
    return {coordinate(0, at[0]), coordinate(1, at[1]), coordinate(2, at[2])};
  }
  bool has_block(const Index3& at) const {
    return at[0] >= 0 && at[1] >= 0 && at[2] >= 0 && at[0] < blocks[0] && at[1] < blocks[1] &&
           at[2] < blocks[2];
  }
};

/// A grid edge with ends on different sides of the surface, and where it crosses.
struct Crossing {
  uint32_t cell;                // the edge starts at corner 0 of this cell
  float at;                     // how far from the start, in cells
  std::array<float, 3> normal;  // unit outward normal there; 0 where there is none
  uint8_t axis;
  bool leaves;  // the start is inside, the end outside
};

/// Cells with surface, in the order of their blocks and, in a block, of x + 8 y + 64 z.
struct Cells {
  Large<Index3> at;
  Large<uint8_t> inside;  // bit c: corner c is inside
  /// Bit 2 a + s: on the ambiguous face on side s along axis a the inside corners are joined.
  Large<uint8_t> joined;
  /// Of each cell: the crossings on its edges from corner 0, along x, y, z, begin there.
  Large<uint32_t> first_crossing;
  Large<Crossing> crossings;

  struct Block {
    std::array<uint64_t, 8> occupied{};  // bit x + 8 y of layer z: a cell with surface
    std::array<uint32_t, 8> first{};     // number of the layer's first cell
    Index3 place{};
  };
  std::vector<Block> blocks;
  std::unordered_map<uint64_t, uint32_t> block_at;
};

/// Finds cells by their place, those in one block and its neighbours at once.
class CellFinder {
 public:
  explicit CellFinder(const Cells& cells) : cells_(cells) {}
  /// The number of a cell with surface.
  uint32_t operator()(const Index3& cell);

 private:
  const Cells::Block& block_at(const Index3& place);

  const Cells& cells_;
  /// The last block that was found for each parity of its place.
  std::array<const Cells::Block*, 8> blocks_{};
};

/// The pieces of surface in a cell: for each of the 12 edges the piece that crosses it, or -1.
struct Pieces {
  std::array<int8_t, 12> of_edge;
  int8_t count;
  /// Of each piece: bit 2 a + s says that it crosses an edge on side s along axis a.
  std::array<uint8_t, 4> sides;
};

/// Faces are numbered as crossings: face i surrounds crossing i. A *use* is a corner of a face,
/// 4 * face + corner.
struct Net {
  std::vector<std::array<uint32_t, 4>> faces;  // counter-clockwise seen from outside
  Large<uint32_t> first_vertex;                // of each cell
  Large<uint32_t> cell;                        // of each vertex
  Large<uint8_t> sides;                        // of each vertex, as Pieces::sides
  size_t vertex_count() const { return cell.size(); }
};

/// The corners of faces at a vertex, ascending.
struct Uses {
  std::array<uint32_t, 12> at;
  uint32_t count = 0;
  const uint32_t* begin() const { return at.data(); }
  const uint32_t* end() const { return at.data() + count; }
};

/// Where things are.
class Places {
 public:
  Places(const Grid& grid, const Cells& cells, const Net& net)
      : grid_(grid), cells_(cells), net_(net) {}
  Vec3 crossing(uint32_t c) const {
    Vec3 p = grid_.point(cells_.at[cells_.crossings[c].cell]);
    p[cells_.crossings[c].axis] += double(cells_.crossings[c].at) * grid_.cell;
    return p;
  }
  /// Unit outward normal at a crossing; 0 where there is none.
  Vec3 normal(uint32_t c) const;
  /// The direction of a crossing's grid edge, outwards.
  Vec3 direction(uint32_t c) const {
    Vec3 result{};
    result[cells_.crossings[c].axis] = cells_.crossings[c].leaves ? 1 : -1;
    return result;
  }
  /// Where a vertex may lie.
  BoundingBox room(uint32_t vertex) const;
  /// The box of a vertex's cell.
  BoundingBox cell_box(uint32_t vertex) const;
  bool is_in_cell(uint32_t vertex, const Vec3& point) const;
  Uses uses(uint32_t vertex) const;

 private:
  const Grid& grid_;
  const Cells& cells_;
  const Net& net_;
};

struct Vertices {
  std::vector<Vec3> at;
  /// Unit outward normals of the smooth ones; 0 for the sharp ones, which may have several.
  Large<std::array<float, 3>> normal;
  std::vector<uint32_t> sharp;  // those that need the work of mesher_features.cpp, ascending
  std::vector<uint32_t> apart;  // smooth ones that may lie out of their cell or share it, ascending

  bool is_smooth(uint32_t v) const {
    const auto& n = normal[v];
    return !(n[0] == 0 && n[1] == 0 && n[2] == 0);
  }
};

/// Makes an empty vector n elements long. Its pages come into being on all threads: making them is
/// most of the time that this takes.
template <class T>
void resize_on_all_threads(std::vector<T>& empty, size_t n) {
  constexpr size_t page = size_t(4) << 10, pages = 512;
  reserve_large(empty, n);
  auto* bytes = reinterpret_cast<volatile char*>(empty.data());
  const size_t all = (n * sizeof(T) + page - 1) / page;
  tbb::parallel_for(size_t(0), (all + pages - 1) / pages, [&](size_t part) {
    for (size_t i = part * pages; i < std::min(all, (part + 1) * pages); ++i) bytes[i * page] = 0;
  });
  empty.resize(n);
}

/// What body(i, to) appends to vectors for each i below n, in the order of i.
template <class T, class Body>
std::vector<T> collected(size_t n, size_t grain, Work& work, const Body& body) {
  std::vector<std::vector<T>> parts((n + grain - 1) / grain);
  work.run(n, grain, [&](size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) body(i, parts[first / grain]);
  });
  std::vector<T> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

/// Whether the face on side s along the axis has two inside corners across from each other.
constexpr bool is_ambiguous(uint8_t inside, int axis, int s) {
  const int e = 1 << (axis + 1) % 3, g = 1 << (axis + 2) % 3, c = s << axis;
  const auto at = [&](int k) { return inside >> k & 1; };
  return at(c) == at(c + e + g) && at(c + e) == at(c + g) && at(c) != at(c + e);
}
constexpr std::array<bool, 256> has_ambiguous_face = [] {
  std::array<bool, 256> table{};
  for (int i = 0; i < 256; ++i) {
    for (int face = 0; face < 6; ++face) {
      table[size_t(i)] = table[size_t(i)] || is_ambiguous(uint8_t(i), face / 2, face % 2);
    }
  }
  return table;
}();

/// Edges, their starts (a corner) and which corner of its face a cell is, where the edge leaves the
/// solid; where it enters: 3 less that.
struct EdgeOfCell {
  int axis, e, g;      // the edge's axis and the two others
  int side_e, side_g;  // where it lies along them
  int corner;
  int face_corner;
};
constexpr std::array<EdgeOfCell, 12> edges_of_cell = [] {
  // Counter-clockwise seen from the end of the edge.
  constexpr int face_corner[2][2] = {{2, 1}, {3, 0}};  // by side in e and in g
  std::array<EdgeOfCell, 12> edges{};
  for (int k = 0; k < 12; ++k) {
    const int axis = k / 4, e = (axis + 1) % 3, g = (axis + 2) % 3, se = k & 1, sg = k >> 1 & 1;
    edges[size_t(k)] = {axis, e, g, se, sg, se << e | sg << g, face_corner[se][sg]};
  }
  return edges;
}();

/// The crossed edges of a cell with these corners inside: bit k is set for edge k.
constexpr std::array<uint16_t, 256> crossed_edges = [] {
  std::array<uint16_t, 256> table{};
  for (size_t inside = 0; inside < 256; ++inside) {
    for (size_t k = 0; k < 12; ++k) {
      const int start = edges_of_cell[k].corner, end = start | 1 << edges_of_cell[k].axis;
      table[inside] |= uint16_t(((inside >> start ^ inside >> end) & 1) << k);
    }
  }
  return table;
}();

/// The number of the crossing on an edge along the axis that starts at the cell's corner 0.
inline uint32_t crossing_at(const Cells& cells, uint32_t cell, int axis) {
  // Edges 0, 4 and 8 do.
  constexpr int before[3] = {0, 0x001, 0x011};
  const int crossed = crossed_edges[cells.inside[cell]] & before[axis];
  return cells.first_crossing[cell] + uint32_t((crossed & 1) + (crossed >> 4));
}

/// Where the vertex of a piece with these sides (Pieces::sides) may lie. A face's four vertices lie
/// in the four quadrants around its grid edge, so that the face, seen along the edge, is a simple
/// polygon that is not turned over: the piece's edges at a side of the cell keep the vertex from
/// passing that side. Past a side without such an edge the vertex may follow the tip of a ridge
/// that pokes out of the cell.
/// `lo`: where corner 0 of the cell lies.
inline BoundingBox room_of(const Grid& grid, const Vec3& lo, uint8_t sides) {
  constexpr double margin = 1e-4;
  constexpr double below[2] = {-1, margin}, above[2] = {2, 1 - margin};
  BoundingBox room;
  for (int axis = 0; axis < 3; ++axis) {
    room.lo[axis] = lo[axis] + below[sides >> (2 * axis) & 1] * grid.cell;
    room.hi[axis] = lo[axis] + above[sides >> (2 * axis + 1) & 1] * grid.cell;
  }
  return room;
}
inline Vec3 clamped(const Vec3& point, const BoundingBox& room) {
  Vec3 result;
  for (int axis = 0; axis < 3; ++axis) {
    result[axis] = std::clamp(point[axis], room.lo[axis], room.hi[axis]);
  }
  return result;
}

/// Throws Error when the mesh would not fit into `memory_limit` bytes. From then on the field has
/// shorter programs for the blocks.
Cells find_cells(Field& field, const Grid& grid, size_t memory_limit, Work& work);
/// A crossed grid edge's start and the field's values at its start and end.
struct Edge {
  Index3 at;
  float start, end;
};
/// Sets where the n crossings lie and their normals; the program is good for all of them.
void locate(const Field& field, const Grid& grid, const Evaluator& program, const Edge* edges,
            size_t n, Crossing* crossings);
Pieces pieces_of(uint8_t inside, uint8_t joined);
/// Settles ambiguous faces so that the mesh is manifold, then numbers vertices. The faces are made
/// by place_vertices.
Net build_net(Cells& cells, Work& work);
/// Makes the faces, places the smooth vertices and finds the sharp ones.
Vertices place_vertices(const Field& field, const Grid& grid, const Cells& cells, Net& net,
                        Work& work);
/// Moves the sharp vertices onto edges and corners.
void place_features(const Field& field, const Grid& grid, const Net& net, const Places& places,
                    Vertices& vertices, Work& work);
/// Of each face that turned over or shrank to nothing, because sharp vertices lie outside of their
/// room, the vertex that lies farthest outside.
std::vector<uint32_t> vertices_to_take_back(const Grid& grid, const Net& net, const Places& places,
                                            const Vertices& vertices, Work& work);
/// Moves the smooth neighbours of these vertices, which left their rooms, away where that unfolds
/// their faces; whether any were moved.
bool make_room(const Field& field, const Grid& grid, const Net& net, const Places& places,
               const std::vector<uint32_t>& numbers, Vertices& vertices);
/// Pieces of surface that touch stay apart: programs that merge equal points would join them.
void separate(const Grid& grid, const Net& net, const Places& places, Vertices& vertices,
              Work& work);
/// Sets corner normals and creases and chooses diagonals. The mesh has vertices and faces already.
void finish_faces(const Field& field, const Grid& grid, const Places& places,
                  const Vertices& vertices, Mesh& mesh, Work& work);
/// `sharp_faces`: those at sharp vertices.
std::vector<std::array<uint32_t, 2>> find_creases(const Mesh& mesh, const Vertices& vertices,
                                                  const std::vector<uint32_t>& sharp_faces,
                                                  Work& work);
/// Sets the corner normals of faces at smooth vertices and chooses the diagonals of those that have
/// only such ones, from the face `first` to `last`.
void finish_smooth_faces(const Grid& grid, const Vertices& vertices, Mesh& mesh, size_t first,
                         size_t last);
/// Turns a quad so that the triangles that its first and third corner part agree better with the
/// corner normals than those of the other diagonal.
void choose_diagonal(Mesh& mesh, size_t face);

}  // namespace sardf::mesher
