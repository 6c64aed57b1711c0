// GLB: glTF 2.0 in one file (Khronos Group 2021, ISO/IEC 12113:2022).
#include <cctype>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "sardf/error.hpp"
#include "sardf/mesh_file_formats.hpp"

namespace sardf::mesh_file {

namespace {

using Json = nlohmann::ordered_json;

// Numbers that the format gives names in its specification.
constexpr int float_type = 5126, uint32_type = 5125;
constexpr int vertex_buffer = 34962, index_buffer = 34963;
constexpr uint32_t magic = 0x46546C67, json_chunk = 0x4E4F534A, binary_chunk = 0x004E4942;

// The binary chunk and the tables that describe it.
class Buffer {
 public:
  /// Adds rows of `width` floats; the number of the accessor. `bounds`: with least and largest.
  size_t add_floats(const std::vector<float>& values, size_t width, bool bounds = false) {
    static const char* const types[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
    const size_t begin = bytes_.size();
    for (const float value : values) append(bytes_, value);
    Json accessor = accessor_at(begin, vertex_buffer, float_type, values.size() / width);
    accessor["type"] = types[width];
    if (bounds) {
      std::vector<float> lo(width, std::numeric_limits<float>::max()), hi(width, -lo[0]);
      for (size_t i = 0; i < values.size(); ++i) {
        lo[i % width] = std::min(lo[i % width], values[i]);
        hi[i % width] = std::max(hi[i % width], values[i]);
      }
      accessor["min"] = lo;
      accessor["max"] = hi;
    }
    accessors.push_back(accessor);
    return accessors.size() - 1;
  }

  size_t add_indices(const std::vector<uint32_t>& indices) {
    const size_t begin = bytes_.size();
    for (const uint32_t index : indices) append(bytes_, index);
    Json accessor = accessor_at(begin, index_buffer, uint32_type, indices.size());
    accessor["type"] = "SCALAR";
    accessors.push_back(accessor);
    return accessors.size() - 1;
  }

  const std::string& bytes() const { return bytes_; }
  Json accessors = Json::array(), views = Json::array();

 private:
  Json accessor_at(size_t begin, int target, int type, size_t count) {
    views.push_back({{"buffer", 0},
                     {"byteOffset", begin},
                     {"byteLength", bytes_.size() - begin},
                     {"target", target}});
    return {{"bufferView", views.size() - 1}, {"componentType", type}, {"count", count}};
  }

  std::string bytes_;
};

// glTF has y up: (x, y, z) becomes (x, z, -y).
std::array<float, 3> y_up(const Vec3& p, double scale) {
  return {float(scale * p[0]), float(scale * p[2]), float(-scale * p[1])};
}

// Rows of a list at the vertices, one for each corner.
std::vector<float> spread(const Corners& corners, const std::vector<float>& values, size_t width,
                          size_t first, size_t count) {
  std::vector<float> result;
  result.reserve(corners.unique.size() * count);
  for (const auto& corner : corners.unique) {
    for (size_t k = first; k < first + count; ++k) {
      result.push_back(values[corner.vertex * width + k]);
    }
  }
  return result;
}

// "_MATERIAL_" and the name with only letters, digits and "_", different for each.
std::string attribute_name(const std::string& name, std::set<std::string>& taken) {
  std::string result = "_MATERIAL_";
  for (const char c : name) {
    result += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  }
  const std::string base = result;
  for (int k = 2; !taken.insert(result).second; ++k) result = base + "_" + std::to_string(k);
  return result;
}

Json add_attributes(const Mesh& mesh, const MeshAttributes& attributes, double scale,
                    const Corners& corners, Buffer& buffer, Json& names) {
  std::vector<float> positions, normals, uv;
  for (const auto& corner : corners.unique) {
    const auto p = y_up(mesh.vertices[corner.vertex], scale);
    positions.insert(positions.end(), p.begin(), p.end());
    normals.insert(normals.end(), {corner.normal[0], corner.normal[2], 0.0f - corner.normal[1]});
    uv.insert(uv.end(), {corner.uv[0], 1 - corner.uv[1]});  // v downwards
  }
  Json result;
  result["POSITION"] = buffer.add_floats(positions, 3, true);
  if (!mesh.corner_normals.empty()) result["NORMAL"] = buffer.add_floats(normals, 3);
  if (!mesh.corner_uv.empty()) result["TEXCOORD_0"] = buffer.add_floats(uv, 2);
  if (!attributes.colors.empty()) {
    result["COLOR_0"] = buffer.add_floats(spread(corners, attributes.colors, 3, 0, 3), 3);
  }
  std::set<std::string> taken;
  const size_t materials = attributes.fraction_names.size();
  for (size_t m = 0; m < materials; ++m) {
    const std::string name = attribute_name(attributes.fraction_names[m], taken);
    names[name] = attributes.fraction_names[m];
    result[name] = buffer.add_floats(spread(corners, attributes.fractions, materials, m, 1), 1);
  }
  return result;
}

Json description(const Mesh& mesh, const MeshAttributes& attributes, double scale, Buffer& buffer) {
  const Corners corners = unique_corners(mesh);
  std::vector<uint32_t> indices;
  for (const auto& triangle : triangulate(mesh)) {
    for (const uint32_t corner : triangle) indices.push_back(corners.index[corner]);
  }
  Json names = Json::object();
  Json primitive;
  primitive["attributes"] = add_attributes(mesh, attributes, scale, corners, buffer, names);
  primitive["indices"] = buffer.add_indices(indices);
  primitive["material"] = 0;
  const double grey = attributes.colors.empty() ? 0.8 : 1;
  Json json;
  json["asset"] = {{"version", "2.0"}, {"generator", "sardf " SARDF_VERSION}};
  json["scene"] = 0;
  json["scenes"] = {{{"nodes", {0}}}};
  json["nodes"] = {{{"mesh", 0}, {"name", "part"}}};
  json["meshes"] = {{{"name", "part"}, {"primitives", {primitive}}}};
  if (!names.empty()) json["meshes"][0]["extras"] = {{"fractions", names}};
  json["materials"] = {{{"name", "part"},
                        {"pbrMetallicRoughness",
                         {{"baseColorFactor", {grey, grey, grey, 1}},
                          {"metallicFactor", 0},
                          {"roughnessFactor", 0.5}}}}};
  json["accessors"] = buffer.accessors;
  json["bufferViews"] = buffer.views;
  json["buffers"] = {{{"byteLength", buffer.bytes().size()}}};
  return json;
}

}  // namespace

std::string glb(const Mesh& mesh, const MeshAttributes& attributes, double metres_per_unit) {
  Buffer buffer;
  std::string json = description(mesh, attributes, metres_per_unit, buffer).dump();
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const size_t length = 12 + 8 + json.size() + 8 + buffer.bytes().size();
  if (length > 0xFFFFFFFFu) {
    throw Error("a GLB file holds at most 4 GiB, this mesh needs " + std::to_string(length) +
                " bytes; write .ply, or lower the resolution");
  }
  std::string bytes;
  for (const uint32_t word : {magic, 2u, uint32_t(length), uint32_t(json.size()), json_chunk}) {
    append(bytes, word);
  }
  bytes += json;
  append(bytes, uint32_t(buffer.bytes().size()));
  append(bytes, binary_chunk);
  return bytes + buffer.bytes();
}

}  // namespace sardf::mesh_file
