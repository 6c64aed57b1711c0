// The formats of mesh_read.hpp, and what they share.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "sardf/error.hpp"
#include "sardf/pulse.hpp"
#include "sardf/vec.hpp"

namespace sardf {

/// A file in memory.
struct MeshBytes {
  std::string path;
  std::string bytes;
  Pulse& pulse;
};

/// Polygons as a file has them.
class PolygonMesh {
 public:
  /// `in_lines`: whether places are lines (from 1), else bytes (from 0). Keeps a reference.
  PolygonMesh(const MeshBytes& file, bool in_lines) : file_(file), in_lines_(in_lines) {}

  /// Says that the reader works, and is at this byte: called for every few words.
  void step(size_t position) {
    if (++steps_ % 64 == 0) file_.pulse(double(position) / double(file_.bytes.size()));
  }

  /// Throws Error when a coordinate is not finite or beyond 1e100.
  void add_vertex(const Vec3& at, uint64_t place);
  void add_corner(int64_t vertex) { corners_.push_back(vertex); }
  /// Ends the polygon whose corners were added. Throws Error when these are fewer than 3.
  void end_polygon(uint64_t place);
  /// Throws Error when a corner is no vertex, or there is no polygon.
  void check() const;
  [[noreturn]] void fail(const std::string& message, uint64_t place) const;

  const std::vector<Vec3>& vertices() const { return vertices_; }
  size_t polygon_count() const { return ends_.size(); }
  std::vector<uint32_t> polygon(size_t i) const;

 private:
  const MeshBytes& file_;
  bool in_lines_;
  size_t steps_ = 0;
  std::vector<Vec3> vertices_;
  std::vector<int64_t> corners_;
  std::vector<size_t> ends_;
  std::vector<uint64_t> places_;
};

PolygonMesh read_ply(const MeshBytes& file);
PolygonMesh read_obj(const MeshBytes& file);
PolygonMesh read_stl(const MeshBytes& file);

/// The words of a text, one after the other, with their lines.
class MeshWords {
 public:
  explicit MeshWords(std::string_view text, uint64_t line = 1) : text_(text), line_(line) {}

  /// The next word of this line; empty at its end.
  std::string_view word();
  /// The next word of this or a later line; empty at the end of the text.
  std::string_view word_of_any_line();
  /// Goes to the next word of this or a later line, or to the end of the text.
  void skip_to_word();
  /// Goes to the next line; false at the end of the text.
  bool next_line();
  /// What is left of this line.
  std::string_view rest_of_line();
  uint64_t line() const { return line_; }
  /// Bytes before the next word.
  size_t position() const { return at_; }

 private:
  void skip_blanks();

  std::string_view text_;
  size_t at_ = 0;
  uint64_t line_;
};

/// Whether the whole word is a number; NaN and infinities are numbers here.
bool parse_number(std::string_view word, double& number);
bool parse_number(std::string_view word, int64_t& number);

}  // namespace sardf
