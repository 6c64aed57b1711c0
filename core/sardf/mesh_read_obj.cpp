// Wavefront OBJ: of its keywords, v and f matter here.
#include "sardf/mesh_read_formats.hpp"

namespace sardf {

namespace {

class ObjReader {
 public:
  explicit ObjReader(const MeshBytes& file) : words_(file.bytes), mesh_(file, true) {}

  PolygonMesh read() {
    do {
      mesh_.step(words_.position());
      const std::string_view keyword = words_.word();
      if (keyword == "v") vertex();
      if (keyword == "f") face();
    } while (words_.next_line());
    return std::move(mesh_);
  }

 private:
  // A line that ends in a backslash goes on in the next.
  std::string_view word() {
    const std::string_view found = words_.word();
    if (found != "\\") return found;
    return words_.next_line() ? word() : std::string_view();
  }

  void vertex() {
    const uint64_t line = words_.line();
    Vec3 at{};
    for (double& a : at) {
      const std::string_view found = word();
      if (parse_number(found, a)) continue;
      mesh_.fail("found " +
                     (found.empty() ? "the end of the line" : "'" + std::string(found) + "'") +
                     " where a vertex has a coordinate; 3 numbers are accepted",
                 line);
    }
    mesh_.add_vertex(at, line);
  }

  void face() {
    const uint64_t line = words_.line();
    for (std::string_view corner = word(); !corner.empty(); corner = word()) {
      mesh_.step(words_.position());
      int64_t index = 0;
      if (!parse_number(corner.substr(0, corner.find('/')), index) || index == 0) {
        mesh_.fail("found '" + std::string(corner) +
                       "' where a face has a corner; a vertex from 1, or from -1 backwards, is "
                       "accepted, alone or as in 1/2/3",
                   line);
      }
      mesh_.add_corner(index > 0 ? index - 1 : index + int64_t(mesh_.vertices().size()));
    }
    mesh_.end_polygon(line);
  }

  MeshWords words_;
  PolygonMesh mesh_;
};

}  // namespace

PolygonMesh read_obj(const MeshBytes& file) { return ObjReader(file).read(); }

}  // namespace sardf
