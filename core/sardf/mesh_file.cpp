#include "sardf/mesh_file.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "sardf/error.hpp"
#include "sardf/mesh_file_formats.hpp"
#include "sardf/output_file.hpp"

namespace sardf {

namespace {

struct Format {
  const char* extension;
  std::string (*encode)(const Mesh&, const MeshAttributes&, double);
};
constexpr Format formats[] = {
    {".ply", mesh_file::ply}, {".obj", mesh_file::obj}, {".glb", mesh_file::glb}};

const Format& format_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = char(std::tolower(static_cast<unsigned char>(c)));
  std::vector<std::string> names;
  for (const Format& format : formats) {
    if (extension == format.extension) return format;
    names.push_back(format.extension);
  }
  const std::string found =
      extension.empty() ? "has no extension" : "has the unknown extension '" + extension + "'";
  throw Error("a mesh file " + found + "; accepted are .ply, .obj and .glb" +
                  did_you_mean(extension, names),
              path);
}

void check_attributes(const std::string& path, const Mesh& mesh, const MeshAttributes& attributes) {
  const size_t n = mesh.vertices.size();
  if (attributes.fractions.size() != n * attributes.fraction_names.size()) {
    throw Error(
        "the fractions do not fit the mesh: " + std::to_string(attributes.fractions.size()) +
            " numbers for " + std::to_string(n) + " vertices and " +
            std::to_string(attributes.fraction_names.size()) + " names",
        path);
  }
  if (!attributes.colors.empty() && attributes.colors.size() != 3 * n) {
    throw Error("the colours do not fit the mesh: " + std::to_string(attributes.colors.size()) +
                    " numbers for " + std::to_string(n) + " vertices",
                path);
  }
}

}  // namespace

void check_mesh_path(const std::string& path) { format_of(path); }

void write_mesh(const std::string& path, const Mesh& mesh, const MeshAttributes& attributes,
                double metres_per_unit) {
  const Format& format = format_of(path);
  check_attributes(path, mesh, attributes);
  OutputFile file(path);
  file.write(format.encode(mesh, attributes, metres_per_unit));
  file.commit();
}

}  // namespace sardf
