#include "sardf/mesh_set.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>

#include "sardf/error.hpp"
#include "sardf/mesh_intersections.hpp"
#include "sardf/short_number.hpp"

namespace sardf {

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
// Nearer than this (local) the direction to the nearest point is lost to rounding.
constexpr double no_direction = 1e-13;

bool encloses_negative_volume(const TriangleTree& tree, Pulse& pulse) {
  double volume = 0;
  for (const TriangleTree::Triangle& t : tree.triangles()) {
    pulse.step(size_t(&t - tree.triangles().data()), tree.triangles().size());
    volume += dot(tree.corner(t, 0), tree.area_vector(t));
  }
  return volume < 0;
}

// Appends the fingerprints of parts of a list.
template <class Rows>
void add_fingerprints(std::vector<double>& to, const Rows& rows, Pulse& pulse) {
  constexpr size_t part = 1 << 14;
  std::vector<double> all;
  to.push_back(double(rows.size()));
  for (size_t first = 0; first < rows.size(); first += part) {
    pulse(double(first) / double(rows.size()));
    all.clear();
    for (size_t i = first; i < std::min(rows.size(), first + part); ++i) {
      all.insert(all.end(), rows[i].begin(), rows[i].end());
    }
    const std::vector<double> found = fingerprint(all);
    to.insert(to.end(), found.begin(), found.end());
  }
}

std::vector<double> mesh_identity(const TriangleMesh& mesh, Pulse& pulse) {
  std::vector<double> parts;
  add_fingerprints(parts, mesh.vertices, pulse);
  add_fingerprints(parts, mesh.triangles, pulse);
  return fingerprint(parts);
}

Pulse& staged(Pulse& pulse, double end) {
  pulse.stage(end);
  return pulse;
}

/// What solids and surfaces have in common.
class MeshPoints : public PointSet {
 public:
  MeshPoints(const char* name, const char* doc, MeshDataPointer data,
             const std::vector<double>& identity)
      : PointSet(name, doc, identity), data_(std::move(data)), tree_(data_->tree()) {}

  Nearest nearest(const Vec3& point) const override { return search(point, nullptr, nullptr); }
  Nearest nearest_beside(const Vec3& point, const Vec3& beside,
                         const Nearest& known) const override {
    return search(point, &beside, &known);
  }

  std::array<Vec3, 3> jacobian(const Vec3& point, const Nearest& at) const override {
    const TriangleTree::Triangle& t = tree_.triangles()[at.part / 8];
    const size_t part = at.part % 8;
    const Vec3 normal = unit_normal(t), away = tree_.to_local(point) - tree_.to_local(at.point);
    // Straight above the end of a face, the face's is one of the two derivatives.
    const bool above = std::abs(dot(away, normal)) > (1 - 1e-12) * quick_norm(away);
    std::array<Vec3, 3> rows{};
    if (part == 0 || (above && quick_norm(away) > no_direction)) {
      for (size_t k = 0; k < 3; ++k) {
        rows[k] = -normal[k] * normal;
        rows[k][k] += 1;
      }
    } else if (part < 4) {
      const Vec3 edge = tree_.corner(t, part % 3) - tree_.corner(t, part - 1);
      for (size_t k = 0; k < 3; ++k) rows[k] = (edge[k] / dot(edge, edge)) * edge;
    }
    return rows;
  }

  std::array<Interval, 3> bounds() const override {
    const Vec3 lo = tree_.from_local(tree_.bounds()[0]), hi = tree_.from_local(tree_.bounds()[1]);
    std::array<Interval, 3> out;
    for (size_t k = 0; k < 3; ++k) {
      // Rounding of a nearest point.
      const double margin = 1e-15 * (std::abs(lo[k]) + std::abs(hi[k]) + tree_.unit());
      out[k] = {lo[k] - margin, hi[k] + margin};
    }
    return out;
  }

 protected:
  /// Whether the point is inside; `beside` and `known` as in nearest_beside, or null.
  struct Query {
    Vec3 point;  // local
    TrianglePoint found;
    const Vec3* beside;
    const Nearest* known;
  };
  virtual bool is_inside(const Query& query, const Nearest& at) const = 0;
  /// The gradient where the distance is 0, or too small to have a direction.
  virtual Vec3 gradient_on(const TrianglePoint& at) const = 0;

  Vec3 unit_normal(const TriangleTree::Triangle& t) const {
    const Vec3 area = tree_.area_vector(t);
    const double length = quick_norm(area);
    return length > 0 ? (1 / length) * area : Vec3{};
  }

  const MeshData& data() const { return *data_; }
  const TriangleTree& tree() const { return tree_; }

 private:
  Nearest search(const Vec3& point, const Vec3* beside, const Nearest* known) const {
    Nearest out;
    const bool is_finite =
        std::all_of(point.begin(), point.end(), [](double a) { return std::isfinite(a); });
    if (!is_finite) return nowhere(point);
    const Vec3 local = tree_.to_local(point);
    const uint32_t guess = known ? uint32_t(known->part / 8) : 0;
    const TrianglePoint found = tree_.nearest(local, guess);
    const Vec3 away = local - found.point;
    // Beyond 1e150 squares overflow.
    const double distance = found.squared < 1e290 ? std::sqrt(found.squared) : norm(away);
    out.point = tree_.from_local(found.point);
    out.distance = tree_.unit() * distance;
    out.part = 8 * uint64_t(found.triangle) + found.part;
    if (kind() == Kind::solid && !is_inside({local, found, beside, known}, out)) {
      out.distance = -out.distance;
    }
    out.gradient = gradient(found, away, distance, out.distance < 0 ? -1 : 1);
    return out;
  }

  Vec3 gradient(const TrianglePoint& found, const Vec3& away, double distance, double sign) const {
    const TriangleTree::Triangle& t = tree_.triangles()[found.triangle];
    if (found.part == 0 && distance > 0 && !t.narrow()) {
      // A face's normal keeps its direction however near the point is.
      const Vec3 normal = unit_normal(t);
      return (dot(away, normal) < 0 ? -sign : sign) * normal;
    }
    if (distance > no_direction) return (sign / distance) * away;
    return gradient_on(found);
  }

  Nearest nowhere(const Vec3& point) const {
    Nearest out;
    out.point = out.gradient = {not_a_number, not_a_number, not_a_number};
    const bool is_number =
        std::none_of(point.begin(), point.end(), [](double a) { return std::isnan(a); });
    out.distance = !is_number ? not_a_number : kind() == Kind::solid ? -infinity : infinity;
    return out;
  }

  MeshDataPointer data_;
  const TriangleTree& tree_;
};

class SurfacePoints final : public MeshPoints {
 public:
  SurfacePoints(MeshDataPointer data, const std::vector<double>& identity)
      : MeshPoints("mesh_surface", "The distance to triangles.", std::move(data), identity) {}

 private:
  bool is_inside(const Query&, const Nearest&) const override { return false; }
  Vec3 gradient_on(const TrianglePoint&) const override {
    return {not_a_number, not_a_number, not_a_number};
  }
};

/// Outward directions of the solid's surface, from its triangles' normals.
class SolidPoints : public MeshPoints {
 public:
  SolidPoints(MeshDataPointer from, const std::vector<double>& identity)
      : MeshPoints("mesh_solid", "The distance to the solid that triangles enclose.",
                   std::move(from), identity),
        solidity_(data().solidity()),
        outward_(solidity_.turned ? -1 : 1) {}
  Kind kind() const override { return Kind::solid; }

 protected:
  Vec3 gradient_on(const TrianglePoint& at) const override {
    const Vec3 out = outward(at);
    const double length = quick_norm(out);
    return length > 0 ? (-1 / length) * out : Vec3{not_a_number, not_a_number, not_a_number};
  }
  virtual Vec3 outward(const TrianglePoint& at) const {
    return outward_ * unit_normal(tree().triangles()[at.triangle]);
  }

  const MeshSolidity& solidity_;
  double outward_;
};

class NormalSolid final : public SolidPoints {
 public:
  NormalSolid(MeshDataPointer from, const std::vector<double>& identity, Pulse& pulse)
      : SolidPoints(std::move(from), identity),
        corner_normals_(vertex_pseudonormals(tree(), pulse)) {}

 private:
  Vec3 outward(const TrianglePoint& at) const override {
    const TriangleTree::Triangle& t = tree().triangles()[at.triangle];
    if (at.part > 3) return outward_ * corner_normals_[t.corners[at.part - 4]];
    const Vec3 normal = SolidPoints::outward(at);
    if (at.part == 0) return normal;
    const uint32_t twin = solidity_.topology.twin(3 * at.triangle + at.part - 1);
    return normal + outward_ * unit_normal(tree().triangles()[twin / 3]);
  }
  bool is_inside(const Query& query, const Nearest&) const override {
    return !(dot(query.point - query.found.point, outward(query.found)) > 0);
  }

  std::vector<Vec3> corner_normals_;
};

class WindingSolid final : public SolidPoints {
 public:
  WindingSolid(MeshDataPointer from, const std::vector<double>& identity)
      : SolidPoints(std::move(from), identity) {}

  bool may_jump(const Vec3& centre, double radius) const override {
    if (solidity_.topology.is_closed()) return false;
    if (!(radius < infinity) || !std::isfinite(norm(centre))) return true;
    const Vec3 local = tree().to_local(centre);
    const double reach = radius / tree().unit() * (1 + 1e-12);
    if (!(std::sqrt(tree().nearest(local).squared) > reach)) return true;
    const Interval winding = solidity_.winding.over_ball(local, reach);
    return !(winding.lo > 0.5 || winding.hi < 0.5);
  }

 private:
  bool is_inside(const Query& query, const Nearest& at) const override {
    if (at.distance == 0) return true;
    // Where there is no triangle in between, a closed mesh winds as often.
    if (query.known && solidity_.topology.is_closed()) {
      const double reach = std::max(at.distance, std::abs(query.known->distance));
      const Vec3 between = query.point - tree().to_local(*query.beside);
      if (tree().unit() * quick_norm(between) < 0.999999 * reach) return query.known->distance > 0;
    }
    const Interval winding = solidity_.winding.over_ball(query.point, 0);
    return winding.lo + winding.hi > 1;
  }
};

}  // namespace

MeshSolidity::MeshSolidity(const TriangleTree& tree, Pulse& pulse)
    : topology(tree, staged(pulse, 0.2)),
      turned(topology.is_closed() && encloses_negative_volume(tree, pulse)),
      winding(tree, turned, staged(pulse, 0.3)),
      fault(topology.fault(staged(pulse, 0.4))) {
  if (fault) return;
  if (const auto meeting = meeting_triangles(tree, staged(pulse, 0.9))) {
    fault = {"meets another face beside common corners and edges", (*meeting)[0]};
    return;
  }
  // On one side of each part there must be nothing, and on the other one layer of solid.
  const std::vector<uint32_t> parts = topology.parts(staged(pulse, 0.95));
  pulse.stage(1);
  for (const uint32_t triangle : parts) {
    pulse(double(&triangle - parts.data()) / double(parts.size()));
    if (std::abs(winding.on_triangle(triangle) - 0.5) < 0.25) continue;
    fault = {"is part of a surface that is inside out, or lies within another", triangle};
    return;
  }
}

MeshData::MeshData(TriangleMesh mesh, const Progress& progress)
    : MeshData(std::move(mesh), Pulse(progress)) {}

MeshData::MeshData(TriangleMesh mesh, Pulse&& pulse)
    : mesh_(std::move(mesh)),
      tree_(mesh_.vertices, mesh_.triangles, pulse),
      identity_(mesh_identity(mesh_, pulse)) {}

const MeshSolidity& MeshData::solidity(const Progress& progress) const {
  std::call_once(once_, [&] {
    Pulse pulse(progress);
    solidity_ = std::make_unique<MeshSolidity>(tree_, pulse);
  });
  return *solidity_;
}

uint32_t MeshData::polygon(uint32_t tree_triangle) const {
  return mesh_.polygons[tree_.triangles()[tree_triangle].given()];
}

MeshDataPointer mesh_data(const std::string& path, const Progress& progress) {
  namespace fs = std::filesystem;
  struct Known {
    uintmax_t size = 0;
    fs::file_time_type time;
    std::weak_ptr<const MeshData> data;
  };
  static std::mutex mutex;
  static std::map<std::string, Known> all;

  std::error_code error;
  const std::string place = fs::weakly_canonical(path, error).string();
  const uintmax_t size = fs::file_size(path, error);
  const fs::file_time_type time = error ? fs::file_time_type() : fs::last_write_time(path, error);
  {
    const std::lock_guard lock(mutex);
    const auto known = all.find(place);
    if (!error && known != all.end() && known->second.size == size && known->second.time == time) {
      if (MeshDataPointer data = known->second.data.lock()) return data;
    }
  }
  // Read without the lock: another thread may want another file.
  TriangleMesh mesh = read_triangle_mesh(path, part_of(progress, 0, 0.6));
  auto data = std::make_shared<const MeshData>(std::move(mesh), part_of(progress, 0.6, 1));
  const std::lock_guard lock(mutex);
  std::erase_if(all, [](const auto& entry) { return entry.second.data.expired(); });
  all[place] = {size, time, data};
  return data;
}

MeshSolidSet solid_of_mesh(const MeshDataPointer& data, const std::string& sign,
                           const Progress& progress) {
  if (sign != "auto" && sign != "normals" && sign != "winding") {
    throw Error("sign is '" + sign + "'; 'auto', 'normals' and 'winding' are accepted" +
                did_you_mean(sign, {"auto", "normals", "winding"}));
  }
  const MeshSolidity& solidity = data->solidity(part_of(progress, 0, 0.9));
  const std::optional<MeshTopology::Fault>& fault = solidity.fault;
  if (sign == "normals" && fault) {
    throw Error(
        "sign is 'normals', which needs a closed, oriented mesh that does not run into "
        "itself, but face " +
        std::to_string(data->polygon(fault->triangle)) + ", counted from 0, " + fault->text +
        "; 'winding' and 'auto' are accepted");
  }
  const bool by_normals = sign != "winding" && !fault;
  std::vector<double> identity = data->identity();
  identity.push_back(by_normals ? 1 : 2);
  const Exactness how = !fault                          ? Exactness::exact
                        : solidity.topology.is_closed() ? Exactness::bound
                                                        : Exactness::estimate;
  if (by_normals) {
    const Progress rest = part_of(progress, 0.9, 1);
    Pulse pulse(rest);
    pulse.stage(1);
    return {std::make_shared<NormalSolid>(data, identity, pulse), {how, how}};
  }
  return {std::make_shared<WindingSolid>(data, identity), {how, how}};
}

PointSetPointer surface_of_mesh(const MeshDataPointer& data, const std::vector<double>& faces,
                                const Progress& progress) {
  if (faces.empty()) return std::make_shared<SurfacePoints>(data, data->identity());
  const TriangleMesh& all = data->mesh();
  std::vector<bool> wanted(all.polygon_count);
  for (const double face : faces) {
    if (face >= 0 && face < double(all.polygon_count) && face == std::floor(face)) {
      wanted[size_t(face)] = true;
      continue;
    }
    throw Error("faces names face " + short_number(face, 6) + "; whole numbers from 0 to " +
                std::to_string(all.polygon_count - 1) + " are accepted for this mesh");
  }
  TriangleMesh part;
  part.vertices = all.vertices;
  part.polygon_count = all.polygon_count;
  for (size_t i = 0; i < all.triangles.size(); ++i) {
    if (!wanted[all.polygons[i]]) continue;
    part.triangles.push_back(all.triangles[i]);
    part.polygons.push_back(all.polygons[i]);
  }
  const auto made = std::make_shared<const MeshData>(std::move(part), progress);
  return std::make_shared<SurfacePoints>(made, made->identity());
}

}  // namespace sardf
