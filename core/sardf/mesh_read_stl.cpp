// STL: facets of three positions each, as text or in binary.
#include <bit>
#include <cstring>

#include "sardf/mesh_read_formats.hpp"

namespace sardf {

namespace {

constexpr size_t header_size = 84, facet_size = 50;

uint32_t word_at(const std::string& bytes, size_t at) {
  uint32_t word = 0;
  for (size_t i = 4; i-- > 0;) word = word << 8 | uint8_t(bytes[at + i]);
  return word;
}

PolygonMesh read_binary(const MeshBytes& file) {
  PolygonMesh mesh(file, false);
  const size_t facets = word_at(file.bytes, header_size - 4);
  for (size_t i = 0; i < facets; ++i) {
    const size_t facet = header_size + i * facet_size;
    mesh.step(facet);
    for (size_t corner = 0; corner < 3; ++corner) {
      const size_t at = facet + 12 * (corner + 1);
      Vec3 position{};
      for (size_t k = 0; k < 3; ++k) {
        position[k] = double(std::bit_cast<float>(word_at(file.bytes, at + 4 * k)));
      }
      mesh.add_corner(int64_t(mesh.vertices().size()));
      mesh.add_vertex(position, at);
    }
    mesh.end_polygon(facet);
  }
  return mesh;
}

class TextReader {
 public:
  explicit TextReader(const MeshBytes& file) : words_(file.bytes), mesh_(file, true) {}

  PolygonMesh read() {
    bool ended = false;
    for (std::string_view word; !(word = words_.word_of_any_line()).empty();) {
      mesh_.step(words_.position());
      ended = word == "endsolid";
      if (word == "solid" || ended) {
        words_.next_line();  // the rest is a name
      } else if (word == "facet") {
        facet();
      } else {
        unexpected(word, "facet or endsolid");
      }
    }
    if (!ended) mesh_.fail("the file ends without endsolid", words_.line());
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void unexpected(std::string_view word, const std::string& accepted) {
    mesh_.fail("found " + (word.empty() ? "the end of the file" : "'" + std::string(word) + "'") +
                   "; " + accepted + " is accepted here",
               words_.line());
  }

  void expect(const char* accepted) {
    const std::string_view word = words_.word_of_any_line();
    if (word != accepted) unexpected(word, accepted);
  }

  double number() {
    double value = 0;
    const std::string_view word = words_.word_of_any_line();
    if (!parse_number(word, value)) unexpected(word, "a number");
    return value;
  }

  // Normals are not read: the order of the corners says the same.
  void facet() {
    const uint64_t line = words_.line();
    expect("normal");
    for (int i = 0; i < 3; ++i) words_.word_of_any_line();
    expect("outer");
    expect("loop");
    for (std::string_view word; (word = words_.word_of_any_line()) != "endloop";) {
      if (word != "vertex") unexpected(word, "vertex or endloop");
      mesh_.step(words_.position());
      const uint64_t at = words_.line();
      const double x = number(), y = number(), z = number();
      mesh_.add_corner(int64_t(mesh_.vertices().size()));
      mesh_.add_vertex({x, y, z}, at);
    }
    mesh_.end_polygon(line);
    expect("endfacet");
  }

  MeshWords words_;
  PolygonMesh mesh_;
};

}  // namespace

PolygonMesh read_stl(const MeshBytes& file) {
  // Binary files may begin with "solid", too: their size tells, or zeros, which no text has.
  const size_t size = file.bytes.size();
  const size_t facets = size >= header_size ? word_at(file.bytes, header_size - 4) : 0;
  if (size >= header_size && size == header_size + facets * facet_size) return read_binary(file);
  if (file.bytes.find_first_not_of(" \t\r\n") == file.bytes.find("solid") &&
      file.bytes.find('\0') == std::string::npos) {
    return TextReader(file).read();
  }
  if (size < header_size) {
    throw Error("the file has " + std::to_string(size) +
                    " bytes and does not begin with 'solid'; " + "a binary STL file has at least " +
                    std::to_string(header_size),
                file.path);
  }
  throw Error("the file announces " + std::to_string(facets) + " facets, which need " +
                  std::to_string(header_size + facets * facet_size) + " bytes; it has " +
                  std::to_string(size),
              file.path);
}

}  // namespace sardf
