// Shared by the stages of the mesher, in their order: blocks, cells, net, crossings, vertices,
// features, unfold, normals, creases. Private to core/sardf/mesher*.cpp.
//
// Corner c of a cell lies at (c & 1, c >> 1 & 1, c >> 2 & 1). An edge along axis d, with the other
// two axes e = (d + 1) % 3 and g = (d + 2) % 3, is number 4 d + (side in e) + 2 (side in g).
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "sardf/mesh.hpp"
#include "sardf/mesher_field.hpp"
#include "sardf/work.hpp"

namespace sardf::mesher {

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
};

/// A grid edge with ends on different sides of the surface. It starts at grid point `at`.
struct Crossing {
  Index3 at;
  uint8_t axis;
  bool leaves;       // the start is inside, the end outside
  float start, end;  // values of the field there
};

/// Cells with surface, in the order of their blocks and, in a block, of x + 8 y + 64 z.
struct Cells {
  std::vector<Index3> at;
  std::vector<uint8_t> inside;  // bit c: corner c is inside
  /// Bit 2 a + s: on the ambiguous face on side s along axis a the inside corners are joined.
  std::vector<uint8_t> joined;
  std::vector<Crossing> crossings;

  struct Block {
    std::array<uint64_t, 8> occupied{};  // bit x + 8 y of layer z: a cell with surface
    std::array<uint32_t, 8> first{};     // number of the layer's first cell
  };
  std::vector<Block> blocks;
  std::unordered_map<uint64_t, uint32_t> block_at;
};

/// Finds cells by their place, those in one block after the other at once.
class CellFinder {
 public:
  explicit CellFinder(const Cells& cells) : cells_(cells) {}
  /// The number of a cell with surface; `none` for any other.
  static constexpr uint32_t none = 0xFFFFFFFFu;
  uint32_t operator()(const Index3& cell);

 private:
  const Cells& cells_;
  Index3 place_{-1, -1, -1};             // of the last block
  const Cells::Block* block_ = nullptr;  // null: there is none at that place
};

/// The pieces of surface in a cell: for each of the 12 edges the piece that crosses it, or -1.
struct Pieces {
  std::array<int8_t, 12> of_edge;
  int count;
};

/// Faces are numbered as crossings: face i surrounds crossing i. A *use* is a corner of a face,
/// 4 * face + corner.
struct Net {
  std::vector<std::array<uint32_t, 4>> faces;  // counter-clockwise seen from outside
  std::vector<int8_t> direction;               // of each face: its grid edge points outwards along
                                               // axis direction - 1, or -direction - 1 backwards
  std::vector<uint32_t> cell;                  // of each vertex
  std::vector<uint32_t> first_use;             // of each vertex, and the end of the last
  std::vector<uint32_t> uses;                  // of vertex v: first_use[v] to first_use[v + 1]
  std::vector<BoundingBox> room;               // of each vertex, see mesher_cells.cpp
  size_t vertex_count() const { return cell.size(); }
  Vec3 direction_of(uint32_t face) const {
    Vec3 result{};
    result[std::abs(direction[face]) - 1] = direction[face] > 0 ? 1 : -1;
    return result;
  }
};

/// Where the crossings lie and the unit outward normals there (0 where there is none).
struct CrossingPoints {
  std::vector<Vec3> at;
  std::vector<Vec3> normal;
};

struct Vertices {
  std::vector<Vec3> at;
  std::vector<Vec3> normal;     // unit outward normals (0 where there is none)
  std::vector<uint32_t> sharp;  // vertices that need the work of mesher_features.cpp, ascending
};

Vec3 clamped(const Vec3& point, const BoundingBox& room);

/// Throws Error when the mesh would not fit into `memory_limit` bytes. From then on the field has
/// shorter programs for the blocks.
Cells find_cells(Field& field, const Grid& grid, size_t memory_limit, Work& work);
Pieces pieces_of(uint8_t inside, uint8_t joined);
/// Settles ambiguous faces so that the mesh is manifold, then numbers vertices and makes faces.
Net build_net(Cells& cells, const Grid& grid, Work& work);
CrossingPoints find_crossings(const Field& field, const Grid& grid,
                              const std::vector<Crossing>& crossings, Work& work);
Vertices place_vertices(const Field& field, const Grid& grid, const Net& net,
                        const CrossingPoints& crossings, Work& work);
/// Moves the sharp vertices onto edges and corners.
void place_features(const Field& field, const Grid& grid, const Net& net,
                    const CrossingPoints& crossings, Vertices& vertices, Work& work);
/// Of each face that turned over or shrank to nothing, because sharp vertices lie outside of their
/// room, the vertex that lies farthest outside.
std::vector<uint32_t> vertices_to_take_back(const Grid& grid, const Net& net,
                                            const CrossingPoints& crossings,
                                            const Vertices& vertices);
/// Unit outward normals, one for each use; 0 where there is none.
std::vector<Vec3> find_normals(const Field& field, const Grid& grid, const Net& net,
                               const CrossingPoints& crossings, const Vertices& vertices,
                               Work& work);
std::vector<std::array<uint32_t, 2>> find_creases(const Net& net, const Vertices& vertices,
                                                  const std::vector<Vec3>& corner_normals);
/// Turns each quad so that the triangles that its first and third corner part agree better with the
/// corner normals than those of the other diagonal.
void choose_diagonals(Mesh& mesh, Work& work);

}  // namespace sardf::mesher
