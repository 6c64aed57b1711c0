// Embree's point query on a triangle mesh, to compare with.
#pragma once

#include <memory>

#include "sardf/mesh_read.hpp"

namespace sardf::bench {

class EmbreeMesh {
 public:
  explicit EmbreeMesh(const TriangleMesh& mesh);
  ~EmbreeMesh();
  /// Unsigned, in float.
  float distance(float x, float y, float z) const;

 private:
  struct Handles;
  std::unique_ptr<Handles> handles_;
};

}  // namespace sardf::bench
