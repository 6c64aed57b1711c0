#include "sardf/local_programs.hpp"

#include <algorithm>
#include <memory>

#include "sardf/shorten.hpp"

namespace sardf::local {

namespace {

// Shares of the instructions that are left out: from which on it is worth it, and from which on
// nothing better is looked for.
constexpr double worth_it = 0.25, much = 0.5;

}  // namespace

Cube::Cube(const Vec3& center, double half, double wait, Experience& experience)
    : center_(center), half_(half), wait_(wait), experience_(experience) {}

Cube::~Cube() {
  delete program_.load();
  for (const auto& child : children_) delete child.load();
}

BoundingBox Cube::around(double reach) const {
  const Vec3 way{reach, reach, reach};
  return {center_ - way, center_ + way};
}

bool Cube::is_good_for(const BoundingBox& points) const {
  for (size_t axis = 0; axis < 3; ++axis) {
    if (!(points.lo[axis] >= center_[axis] - 2 * half_ &&
          points.hi[axis] <= center_[axis] + 2 * half_))
      return false;
  }
  return true;
}

const Evaluator& Cube::program_after(size_t n, const Evaluator& above) {
  if (!is_tried()) {
    const bool is_due = double(seen_.fetch_add(n, std::memory_order_relaxed) + n) >= wait_;
    if (!is_due || experience_.is_full() || is_begun_.test_and_set()) return above;
  }
  return program(above);
}

const Evaluator& Cube::program(const Evaluator& above) {
  if (!is_tried()) attempt(above);
  const Evaluator* const own = program_.load(std::memory_order_acquire);
  return own ? *own : above;
}

bool Cube::is_promising() const { return gain_.load(std::memory_order_relaxed) >= worth_it; }

void Cube::attempt(const Evaluator& above) {
  const double before = length(above);
  const auto gain_of = [&](const Evaluator& shorter) { return 1 - length(shorter) / before; };
  auto shorter =
      std::make_unique<const Evaluator>(Shortening(above, around(2 * half_)).shortened());
  const double own = gain_of(*shorter);
  double gain = own;
  // Where little can be left out of the program for all of the cube, much may be out of that for a
  // small part: the one in its middle tells.
  if (gain < much) gain = std::max(gain, gain_of(Shortening(above, around(half_ / 8)).shortened()));
  gain_.store(gain, std::memory_order_relaxed);
  // Another thread may make the same.
  const Evaluator* made = nullptr;
  if (own >= worth_it && program_.compare_exchange_strong(made, shorter.get())) {
    experience_.instructions += shorter->tape().instructions().size();
    shorter.release();
  }
  if (!is_tried_.test_and_set(std::memory_order_acq_rel))
    ++(is_promising() ? experience_.worth_it : experience_.in_vain);
}

Cube& Cube::child(size_t octant) {
  Cube* child = children_[octant].load(std::memory_order_acquire);
  if (child) return *child;
  Vec3 middle = center_;
  for (size_t axis = 0; axis < 3; ++axis) middle[axis] += (octant >> axis & 1 ? 0.5 : -0.5) * half_;
  const double gain = gain_.load(std::memory_order_relaxed);
  const double wait = is_promising() ? experience_.patience / (gain * gain) : more_patience * wait_;
  auto made = std::make_unique<Cube>(middle, 0.5 * half_, wait, experience_);
  if (children_[octant].compare_exchange_strong(child, made.get(), std::memory_order_acq_rel))
    return *made.release();
  return *child;
}

}  // namespace sardf::local
