#include "povray_gen/sample_grid.hpp"

namespace sardf::povray {

std::array<int, 3> position_of(const std::array<int, 3>& counts, size_t index) {
  const size_t nx = size_t(counts[0]), ny = size_t(counts[1]);
  return {int(index % nx), int(index / nx % ny), int(index / nx / ny)};
}

size_t index_of(const std::array<int, 3>& counts, const std::array<int, 3>& p) {
  return size_t(p[0]) + size_t(counts[0]) * (size_t(p[1]) + size_t(counts[1]) * size_t(p[2]));
}

Vec3 SampleGrid::place(const Vec3& at) const {
  Vec3 out;
  for (int k = 0; k < 3; ++k) out[k] = min(box[k].lo + at[k] * step(k), box[k].hi);
  return out;
}

Vec3 SampleGrid::point(size_t index) const {
  const std::array<int, 3> p = position(index);
  return place({double(p[0]), double(p[1]), double(p[2])});
}

}  // namespace sardf::povray
