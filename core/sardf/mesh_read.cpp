#include "sardf/mesh_read.hpp"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "sardf/mesh_read_formats.hpp"
#include "sardf/polygon_triangles.hpp"
#include "sardf/short_number.hpp"

namespace sardf {

namespace {

constexpr double largest_coordinate = 1e100;
// Cutting a concave polygon takes time by the square of its corners.
constexpr size_t most_corners = 20000;

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

template <class Number>
bool parse_whole(std::string_view word, Number& number) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), number);
  return problem == std::errc() && end == word.data() + word.size() && !word.empty();
}

MeshBytes contents(const std::string& path, Pulse& pulse) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  // A folder opens, but cannot be read.
  if (file) file.peek();
  if (!file.is_open() || file.bad() || (file.fail() && !file.eof())) {
    const std::string reason = errno ? std::strerror(errno) : "unknown reason";
    throw Error("cannot read the mesh: " + reason, path);
  }
  file.clear();
  constexpr size_t chunk = 1 << 20;
  std::error_code unknown;
  const uintmax_t size = std::filesystem::file_size(path, unknown);
  std::string bytes;
  if (!unknown) bytes.reserve(size + chunk);
  while (file) {
    const size_t before = bytes.size();
    bytes.resize(before + chunk);
    file.read(&bytes[before], chunk);
    bytes.resize(before + size_t(file.gcount()));
    pulse(unknown || size == 0 ? 0 : double(bytes.size()) / double(size));
  }
  return {path, std::move(bytes), pulse};
}

using Reader = PolygonMesh (*)(const MeshBytes& file);

Reader reader_for(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
  if (ending == ".ply") return read_ply;
  if (ending == ".obj") return read_obj;
  if (ending == ".stl") return read_stl;
  throw Error("the mesh's name ends in '" + ending + "'; .ply, .obj and .stl are accepted" +
                  did_you_mean(ending, {".ply", ".obj", ".stl"}),
              path);
}

/// Gives equal positions equal numbers: the place of the first of them.
class Positions {
 public:
  explicit Positions(size_t count) : slots_(std::bit_ceil(2 * count + 1), empty) {}

  uint32_t number_of(std::vector<Vec3>& vertices, const Vec3& at) {
    size_t slot = hash(at) & (slots_.size() - 1);
    while (slots_[slot] != empty && vertices[slots_[slot]] != at) {
      slot = (slot + 1) & (slots_.size() - 1);
    }
    if (slots_[slot] == empty) {
      slots_[slot] = uint32_t(vertices.size());
      vertices.push_back(at);
    }
    return slots_[slot];
  }

 private:
  static constexpr uint32_t empty = ~0u;

  static size_t hash(const Vec3& at) {
    uint64_t mixed = 0;
    for (const double a : at) {
      mixed = std::rotl((mixed ^ std::bit_cast<uint64_t>(a)) * 0x9E3779B97F4A7C15ull, 31);
    }
    return size_t(mixed ^ (mixed >> 32));
  }

  std::vector<uint32_t> slots_;
};

TriangleMesh to_triangles(const PolygonMesh& from, Pulse& pulse) {
  TriangleMesh mesh;
  mesh.polygon_count = from.polygon_count();
  Positions positions(from.vertices().size());
  std::vector<uint32_t> number;
  number.reserve(from.vertices().size());
  pulse.stage(0.8);
  for (const Vec3& at : from.vertices()) {
    number.push_back(positions.number_of(mesh.vertices, at));
    pulse.step(number.size(), from.vertices().size());
  }

  std::vector<Vec3> corners;
  pulse.stage(1);
  for (size_t i = 0; i < from.polygon_count(); ++i) {
    pulse.step(i, from.polygon_count());
    const std::vector<uint32_t> polygon = from.polygon(i);
    corners.clear();
    for (const uint32_t corner : polygon) corners.push_back(from.vertices()[corner]);
    for (const auto& [a, b, c] : triangulated(corners, pulse)) {
      mesh.triangles.push_back({number[polygon[a]], number[polygon[b]], number[polygon[c]]});
      mesh.polygons.push_back(uint32_t(i));
    }
  }
  return mesh;
}

}  // namespace

void PolygonMesh::fail(const std::string& message, uint64_t place) const {
  if (in_lines_) throw Error(message, file_.path, int(std::min<uint64_t>(place, 2147483647)));
  throw Error("byte " + std::to_string(place) + ": " + message, file_.path);
}

void PolygonMesh::add_vertex(const Vec3& at, uint64_t place) {
  for (const double a : at) {
    if (std::abs(a) <= largest_coordinate) continue;
    fail("vertex " + std::to_string(vertices_.size()) + ", counted from 0, has the coordinate " +
             short_number(a, 6) + "; a finite number of magnitude up to 1e100 is accepted",
         place);
  }
  // Adding 0 leaves no negative zeros, so that equal positions have equal bits.
  vertices_.push_back(at + Vec3{0, 0, 0});
}

void PolygonMesh::end_polygon(uint64_t place) {
  const size_t corners = corners_.size() - (ends_.empty() ? 0 : ends_.back());
  if (corners < 3 || corners > most_corners) {
    fail("face " + std::to_string(ends_.size()) + ", counted from 0, has " +
             std::to_string(corners) + " corners; 3 to " + std::to_string(most_corners) +
             " are accepted",
         place);
  }
  ends_.push_back(corners_.size());
  places_.push_back(place);
}

void PolygonMesh::check() const {
  size_t corner = 0;
  for (size_t i = 0; i < ends_.size(); ++i) {
    file_.pulse.step(i, ends_.size());
    for (; corner < ends_[i]; ++corner) {
      if (corners_[corner] >= 0 && uint64_t(corners_[corner]) < vertices_.size()) continue;
      fail("face " + std::to_string(i) + ", counted from 0, has vertex " +
               std::to_string(corners_[corner]) + ", counted from 0; there are " +
               std::to_string(vertices_.size()) + " vertices",
           places_[i]);
    }
  }
  if (ends_.empty()) throw Error("the mesh has no triangles", file_.path);
  if (vertices_.size() >= (1ull << 31) || corners_.size() >= (1ull << 31)) {
    throw Error("the mesh has more than 2^31 vertices or corners", file_.path);
  }
}

std::vector<uint32_t> PolygonMesh::polygon(size_t i) const {
  std::vector<uint32_t> corners;
  for (size_t k = i == 0 ? 0 : ends_[i - 1]; k < ends_[i]; ++k) {
    corners.push_back(uint32_t(corners_[k]));
  }
  return corners;
}

void MeshWords::skip_blanks() {
  while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
}

std::string_view MeshWords::word() {
  skip_blanks();
  const size_t first = at_;
  while (at_ < text_.size() && text_[at_] != '\n' && !is_blank(text_[at_])) ++at_;
  return text_.substr(first, at_ - first);
}

void MeshWords::skip_to_word() {
  for (skip_blanks(); at_ < text_.size() && text_[at_] == '\n'; skip_blanks()) next_line();
}

std::string_view MeshWords::word_of_any_line() {
  skip_to_word();
  return word();
}

bool MeshWords::next_line() {
  const size_t end = text_.find('\n', at_);
  if (end == std::string_view::npos) {
    at_ = text_.size();
    return false;
  }
  at_ = end + 1;
  ++line_;
  return true;
}

std::string_view MeshWords::rest_of_line() {
  skip_blanks();
  const size_t end = std::min(text_.find('\n', at_), text_.size());
  size_t last = end;
  while (last > at_ && is_blank(text_[last - 1])) --last;
  return text_.substr(at_, last - at_);
}

bool parse_number(std::string_view word, double& number) { return parse_whole(word, number); }
bool parse_number(std::string_view word, int64_t& number) { return parse_whole(word, number); }

TriangleMesh read_triangle_mesh(const std::string& path, const Progress& progress) {
  Pulse pulse(progress);
  const Reader read = reader_for(path);
  pulse.stage(0.2);
  const MeshBytes file = contents(path, pulse);
  pulse.stage(0.7);
  const PolygonMesh polygons = read(file);
  polygons.check();
  return to_triangles(polygons, pulse);
}

}  // namespace sardf
