#include "sardf/cubic_piece.hpp"

#include <algorithm>

#include "sardf/cubic_solver.hpp"
#include "sardf/kernels.hpp"

namespace sardf {

namespace {

/// Coefficients by powers in Bernstein form of degree 5.
template <class T>
std::array<T, 6> bernstein_of(const std::array<T, 6>& powers) {
  std::array<T, 6> all{};
  for (int k = 0; k < 6; ++k) {
    for (int j = 0; j <= k; ++j) {
      all[size_t(k)] = all[size_t(k)] + binomial(k, j) / binomial(5, j) * powers[size_t(j)];
    }
  }
  return all;
}

double distance_to_chord(const Vec3& from_start, const Vec3& chord) {
  const double squared = dot(chord, chord);
  const double at = squared > 0 ? std::clamp(dot(from_start, chord) / squared, 0.0, 1.0) : 0;
  return quick_norm(from_start - at * chord);
}

}  // namespace

CubicPiece::CubicPiece(const Weighted* points) {
  const auto at = [points](int k) { return Vec3{points[k][0], points[k][1], points[k][2]}; };
  const Vec3 first = at(1) - at(0), second = at(2) - at(1), third = at(3) - at(2);
  const Vec3 turn = second - first;
  start = at(0);
  by_1 = 3 * first;
  by_2 = 3 * turn;
  by_3 = (third - second) - turn;
  constant = {0,
              dot(by_1, by_1),
              3 * dot(by_1, by_2),
              2 * dot(by_2, by_2) + 4 * dot(by_1, by_3),
              5 * dot(by_2, by_3),
              3 * dot(by_3, by_3)};
  level = bernstein_of(constant);
  along = bernstein_of<Vec3>({by_1, 2 * by_2, 3 * by_3, {}, {}, {}});
  for (size_t k = 0; k < 6; ++k) {
    length[k] = quick_norm(along[k]);
    longest = std::max(longest, length[k]);
    if (k > 0) change[k - 1] = quick_norm(along[k] - along[k - 1]);
  }
  for (int k = 0; k < 4; ++k) box.add(at(k));
  chord = at(3) - at(0);
  for (const int k : {1, 2}) height = std::max(height, distance_to_chord(at(k) - at(0), chord));
}

double CubicPiece::least_distance(const Vec3& point) const {
  return std::max(distance_to_chord(point - start, chord) - height,
                  std::sqrt(box.squared_distance(point)));
}

bool CubicPiece::is_proven(const Vec3& centre, double radius) const {
  const Vec3 a = start - centre;
  // What a coefficient may be off by, many times over; more for a ball than for its points.
  const double error =
      (radius > 0 ? 0x1p-42 : 0x1p-44) * longest * (longest + quick_norm(a) + radius);
  // So steep f must be: then its zero has all digits but a few.
  const double least_rise = 0x1p-8 * longest * longest + error;
  bool falls = true, grows = true, rises = true;
  double before = 0;
  for (size_t k = 0; k < 6; ++k) {
    const double middle = level[k] + dot(a, along[k]), spread = radius * length[k];
    grows = grows && middle - spread >= error;
    falls = falls && middle + spread <= -error;
    rises = rises && (k == 0 || middle - before - radius * change[k - 1] >= least_rise);
    before = middle;
  }
  return grows || falls || rises;
}

CubicSolver cubic_solver() {
#if defined(SARDF_X86)
  if (instruction_set() == InstructionSet::avx512) return avx512_cubic_solver();
  if (instruction_set() == InstructionSet::avx2) return avx2_cubic_solver();
#endif
  return &cubic::Solver<cubic::Two>::solve;
}

CubicSolver single_cubic_solver() { return &cubic::Solver<cubic::One>::solve; }

}  // namespace sardf
