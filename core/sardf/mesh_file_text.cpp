// PLY and OBJ.
#include <algorithm>
#include <cmath>

#include "sardf/mesh_file_formats.hpp"
#include "sardf/number_text.hpp"
#include "sardf/short_number.hpp"

namespace sardf::mesh_file {

namespace {

// IEC 61966-2-1: what readers of PLY and OBJ take colours for.
float srgb_encoded(float linear) {
  const float c = std::clamp(linear, 0.0f, 1.0f);
  return c <= 0.0031308f ? 12.92f * c : 1.055f * std::pow(c, 1 / 2.4f) - 0.055f;
}

std::vector<Vec3> mean_normals(const Mesh& mesh) {
  std::vector<Vec3> normals(mesh.vertices.size());
  for (size_t i = 0; i < mesh.corner_normals.size(); ++i) {
    if (i % 4 == 3 && is_triangle(mesh.faces[i / 4])) continue;
    Vec3& sum = normals[mesh.faces[i / 4][i % 4]];
    sum = sum + mesh.corner_normals[i];
  }
  for (Vec3& normal : normals) {
    if (norm(normal) > 1e-9) normal = normalized(normal);
  }
  return normals;
}

std::string comment(double metres_per_unit) {
  return "made by sardf " SARDF_VERSION "; z up, unit of length " +
         short_number(metres_per_unit, 9) + " m";
}

std::string ply_header(const Mesh& mesh, const MeshAttributes& attributes, double metres_per_unit) {
  std::string text = "ply\nformat binary_little_endian 1.0\ncomment " + comment(metres_per_unit) +
                     "\nelement vertex " + std::to_string(mesh.vertices.size()) +
                     "\nproperty float x\nproperty float y\nproperty float z\n";
  if (!mesh.corner_normals.empty()) {
    text += "property float nx\nproperty float ny\nproperty float nz\n";
  }
  if (!attributes.colors.empty()) {
    text += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  }
  for (std::string name : attributes.fraction_names) {
    std::replace_if(
        name.begin(), name.end(), [](char c) { return c == ' ' || c == '\n' || c == '\t'; }, '_');
    text += "property float fraction_" + name + "\n";
  }
  text += "element face " + std::to_string(mesh.faces.size()) +
          "\nproperty list uchar uint vertex_indices\n";
  if (!mesh.corner_uv.empty()) text += "property list uchar float texcoord\n";
  return text + "end_header\n";
}

// Text with numbers in the shortest form that gives the same float.
class Lines {
 public:
  Lines& word(const char* text) {
    text_ += text;
    return *this;
  }
  Lines& number(double value) {
    text_ += ' ';
    append_number(text_, float(value));
    return *this;
  }
  Lines& count(size_t value) {
    text_ += std::to_string(value);
    return *this;
  }
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

// Numbers, from 1, of the different values of a list, which are written as lines.
template <class Value>
std::vector<uint32_t> write_values(const std::vector<Value>& values, const char* word,
                                   Lines& lines) {
  std::vector<uint32_t> order(values.size()), number(values.size());
  for (uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    return values[a] != values[b] ? values[a] < values[b] : a < b;
  });
  std::vector<uint32_t> first(values.size());
  for (size_t k = 0; k < order.size(); ++k) {
    const bool same = k > 0 && values[order[k]] == values[order[k - 1]];
    first[order[k]] = same ? first[order[k - 1]] : order[k];
  }
  uint32_t written = 0;
  for (uint32_t i = 0; i < values.size(); ++i) {
    if (first[i] != i) {
      number[i] = number[first[i]];
      continue;
    }
    number[i] = ++written;
    lines.word(word);
    for (const double component : values[i]) lines.number(component);
    lines.word("\n");
  }
  return number;
}

}  // namespace

std::string ply(const Mesh& mesh, const MeshAttributes& attributes, double metres_per_unit) {
  std::string bytes = ply_header(mesh, attributes, metres_per_unit);
  const std::vector<Vec3> normals = mean_normals(mesh);
  const size_t materials = attributes.fraction_names.size();
  for (size_t v = 0; v < mesh.vertices.size(); ++v) {
    for (const double x : mesh.vertices[v]) append(bytes, float(x));
    if (!mesh.corner_normals.empty()) {
      for (const double x : normals[v]) append(bytes, float(x));
    }
    if (!attributes.colors.empty()) {
      for (size_t c = 0; c < 3; ++c) {
        append(bytes, uint8_t(std::lround(255 * srgb_encoded(attributes.colors[3 * v + c]))));
      }
    }
    for (size_t m = 0; m < materials; ++m) append(bytes, attributes.fractions[v * materials + m]);
  }
  for (size_t f = 0; f < mesh.faces.size(); ++f) {
    const uint8_t corners = is_triangle(mesh.faces[f]) ? 3 : 4;
    append(bytes, corners);
    for (uint8_t k = 0; k < corners; ++k) append(bytes, mesh.faces[f][k]);
    if (mesh.corner_uv.empty()) continue;
    append(bytes, uint8_t(2 * corners));
    for (uint8_t k = 0; k < corners; ++k) {
      for (const double x : mesh.corner_uv[4 * f + k]) append(bytes, float(x));
    }
  }
  return bytes;
}

std::string obj(const Mesh& mesh, const MeshAttributes& attributes, double metres_per_unit) {
  Lines lines;
  lines.word("# ").word(comment(metres_per_unit).c_str()).word("\n");
  for (size_t v = 0; v < mesh.vertices.size(); ++v) {
    lines.word("v");
    for (const double x : mesh.vertices[v]) lines.number(x);
    if (!attributes.colors.empty()) {
      for (size_t c = 0; c < 3; ++c) lines.number(srgb_encoded(attributes.colors[3 * v + c]));
    }
    lines.word("\n");
  }
  const std::vector<uint32_t> uv = write_values(mesh.corner_uv, "vt", lines);
  const std::vector<uint32_t> normal = write_values(mesh.corner_normals, "vn", lines);
  for (size_t f = 0; f < mesh.faces.size(); ++f) {
    lines.word("f");
    for (size_t k = 0; k < (is_triangle(mesh.faces[f]) ? 3 : 4); ++k) {
      lines.word(" ").count(mesh.faces[f][k] + 1u);
      if (!uv.empty() || !normal.empty()) lines.word("/");
      if (!uv.empty()) lines.count(uv[4 * f + k]);
      if (!normal.empty()) lines.word("/").count(normal[4 * f + k]);
    }
    lines.word("\n");
  }
  return lines.take();
}

}  // namespace sardf::mesh_file
