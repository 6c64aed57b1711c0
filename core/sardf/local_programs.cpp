#include "sardf/local_programs.hpp"

#include <algorithm>
#include <memory>

#include "sardf/shorten.hpp"

namespace sardf::local {

namespace {

// Shares of the instructions that are left out: where it was worth it, and where nothing better is
// looked for.
constexpr double worth_it = 0.25, much = 0.5;

// Around the box's middle, at most so far.
BoundingBox part_of(const BoundingBox& box, double reach) {
  BoundingBox part = box;
  for (size_t axis = 0; axis < 3; ++axis) {
    part.lo[axis] = std::max(box.lo[axis], box.center()[axis] - reach);
    part.hi[axis] = std::min(box.hi[axis], box.center()[axis] + reach);
  }
  return part;
}

double length(const Evaluator& program) { return double(program.tape().instructions().size()); }

}  // namespace

Cube::Cube(const Vec3& center, double half, double wait, Experience& experience)
    : center_(center), half_(half), wait_(wait), experience_(experience) {}

Cube::~Cube() {
  delete program_.load();
  for (const auto& child : children_) delete child.load();
}

BoundingBox Cube::valid() const {
  const Vec3 reach{2 * half_, 2 * half_, 2 * half_};
  return {center_ - reach, center_ + reach};
}

bool Cube::is_good_for(const BoundingBox& points) const {
  for (size_t axis = 0; axis < 3; ++axis) {
    if (!(points.lo[axis] >= center_[axis] - 2 * half_ &&
          points.hi[axis] <= center_[axis] + 2 * half_))
      return false;
  }
  return true;
}

const Evaluator& Cube::program_after(size_t n, const BoundingBox& points, const Evaluator& above) {
  if (!is_tried()) {
    const bool is_due = double(seen_.fetch_add(n, std::memory_order_relaxed) + n) >= wait_;
    if (!is_due || experience_.is_full() || is_begun_.test_and_set()) return above;
  }
  return program(points, above);
}

const Evaluator& Cube::program(const BoundingBox& points, const Evaluator& above) {
  if (!is_tried()) attempt(points, above);
  const Evaluator* const own = program_.load(std::memory_order_acquire);
  return own ? *own : above;
}

void Cube::attempt(const BoundingBox& points, const Evaluator& above) {
  const double before = length(above);
  auto shorter = std::make_unique<const Evaluator>(Shortening(above, valid()).shortened());
  double gain = 1 - length(*shorter) / before;
  // Where little can be left out of the program for all of the cube, much may be out of that for a
  // small part.
  if (gain < much) {
    const Shortening part(above, part_of(points, half_ / 8));
    gain = std::max(gain, 1 - length(part.shortened()) / before);
  }
  gain_.store(gain, std::memory_order_relaxed);
  ++(gain >= worth_it ? experience_.worth_it : experience_.in_vain);
  // Another thread may have made the same.
  const Evaluator* made = nullptr;
  if (length(*shorter) < before && program_.compare_exchange_strong(made, shorter.get())) {
    experience_.instructions += shorter->tape().instructions().size();
    shorter.release();
  }
  is_tried_.test_and_set(std::memory_order_acq_rel);
}

Cube& Cube::child(size_t octant) {
  Cube* child = children_[octant].load(std::memory_order_acquire);
  if (child) return *child;
  Vec3 middle = center_;
  for (size_t axis = 0; axis < 3; ++axis) middle[axis] += (octant >> axis & 1 ? 0.5 : -0.5) * half_;
  const double gain = gain_.load(std::memory_order_relaxed);
  const double wait =
      gain >= worth_it ? experience_.patience / (gain * gain) : more_patience * wait_;
  auto made = std::make_unique<Cube>(middle, 0.5 * half_, wait, experience_);
  if (children_[octant].compare_exchange_strong(child, made.get(), std::memory_order_acq_rel))
    return *made.release();
  return *child;
}

}  // namespace sardf::local
