#include "embree_distance.hpp"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sardf::bench {

namespace {

struct Point {
  float x, y, z;
  friend Point operator-(Point a, Point b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Point operator+(Point a, Point b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Point operator*(float s, Point a) { return {s * a.x, s * a.y, s * a.z}; }
  friend float dot(Point a, Point b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
};

// As Embree's tutorial closest_point has it (Ericson 2005, section 5.1.5).
Point on_triangle(Point p, Point a, Point b, Point c) {
  const Point ab = b - a, ac = c - a, ap = p - a;
  const float d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const Point bp = p - b;
  const float d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const Point cp = p - c;
  const float d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + (d1 / (d1 - d3)) * ab;
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + (d2 / (d2 - d6)) * ac;
  const float va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    return b + ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (c - b);
  }
  const float whole = 1 / (va + vb + vc);
  return a + (vb * whole) * ab + (vc * whole) * ac;
}

struct Query {
  const Point* vertices;
  const uint32_t* corners;
  float best;
};

bool visit(RTCPointQueryFunctionArguments* at) {
  Query& query = *static_cast<Query*>(at->userPtr);
  const uint32_t* corner = query.corners + 3 * at->primID;
  const Point p{at->query->x, at->query->y, at->query->z};
  const Point away = p - on_triangle(p, query.vertices[corner[0]], query.vertices[corner[1]],
                                     query.vertices[corner[2]]);
  const float distance = std::sqrt(dot(away, away));
  if (!(distance < query.best)) return false;
  query.best = at->query->radius = distance;
  return true;
}

}  // namespace

struct EmbreeMesh::Handles {
  RTCDevice device;
  RTCScene scene;
  const Point* vertices;
  const uint32_t* corners;
};

EmbreeMesh::EmbreeMesh(const TriangleMesh& mesh) : handles_(std::make_unique<Handles>()) {
  handles_->device = rtcNewDevice(nullptr);
  handles_->scene = rtcNewScene(handles_->device);
  const RTCGeometry geometry = rtcNewGeometry(handles_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<Point*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Point), mesh.vertices.size()));
  auto* corners = static_cast<uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(uint32_t), mesh.triangles.size()));
  for (size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Vec3& v = mesh.vertices[i];
    vertices[i] = {float(v[0]), float(v[1]), float(v[2])};
  }
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    std::copy(mesh.triangles[i].begin(), mesh.triangles[i].end(), corners + 3 * i);
  }
  handles_->vertices = vertices;
  handles_->corners = corners;
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(handles_->scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(handles_->scene);
}

EmbreeMesh::~EmbreeMesh() {
  rtcReleaseScene(handles_->scene);
  rtcReleaseDevice(handles_->device);
}

float EmbreeMesh::distance(float x, float y, float z) const {
  const float unbounded = std::numeric_limits<float>::infinity();
  Query query{handles_->vertices, handles_->corners, unbounded};
  RTCPointQuery point{x, y, z, 0, unbounded};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(handles_->scene, &point, &context, &visit, &query);
  return query.best;
}

}  // namespace sardf::bench
