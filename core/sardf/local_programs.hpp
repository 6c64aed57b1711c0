// An octree of programs, each shortened for its cube from that of the cube around it (shorten.hpp);
// private to local_evaluator.cpp.
//
// It grows where points are evaluated. A cube's program depends on the cube alone, and on nothing
// that was evaluated before: only whether it is there yet does.
#pragma once

#include <array>
#include <atomic>

#include "sardf/evaluate.hpp"

namespace sardf::local {

/// A program of this many instructions is not shortened: it costs less than finding out.
inline constexpr size_t short_program = 8;
/// A cube in a row in which that was not worth it waits for so many times the points of the one
/// around it.
inline constexpr double more_patience = 8;

/// Instructions.
inline double length(const Evaluator& program) {
  return double(program.tape().instructions().size());
}

/// What all cubes of a tree have in common.
struct Experience {
  double patience;  // points that take as long as to find out what is not needed
  std::atomic<int> in_vain{0}, worth_it{0};
  std::atomic<size_t> instructions{0};  // of all programs

  /// Whether not much could be left out anywhere, so far.
  bool is_hopeless() const {
    constexpr int enough = 9;  // the whole and its octants, say
    return in_vain.load(std::memory_order_relaxed) >= enough &&
           worth_it.load(std::memory_order_relaxed) == 0;
  }
  /// An instruction takes a hundred bytes, about; one that was narrowed (a polygon) more.
  bool is_full() const {
    constexpr size_t most_instructions = 2'000'000;
    return instructions.load(std::memory_order_relaxed) >= most_instructions;
  }
};

class Cube {
 public:
  /// `wait`: points that are evaluated in it before it is to have a program.
  Cube(const Vec3& center, double half, double wait, Experience& experience);
  ~Cube();
  Cube(const Cube&) = delete;
  Cube& operator=(const Cube&) = delete;

  /// Where its program is good: up to half an edge around it, so that points near its border need
  /// not be told apart.
  bool is_good_for(const BoundingBox& points) const;

  /// The program here, after n points more: `above`, that of the cube around it, until there are
  /// enough of them and it has been made, and where not much can be left out.
  const Evaluator& program_after(size_t n, const Evaluator& above);
  /// The same at once, so that it does not matter what was evaluated before.
  const Evaluator& program(const Evaluator& above);
  /// Whether much can be left out here, or in a part; known when it has been tried.
  bool is_promising() const;
  bool is_tried() const { return is_tried_.test(std::memory_order_acquire); }

  static size_t octant(const Vec3& center, const Vec3& point) {
    return size_t(point[0] >= center[0]) | size_t(point[1] >= center[1]) << 1 |
           size_t(point[2] >= center[2]) << 2;
  }
  const Vec3& center() const { return center_; }
  double edge() const { return 2 * half_; }
  /// An eighth of the cube; made if it is not there yet.
  Cube& child(size_t octant);

 private:
  BoundingBox around(double reach) const;
  void attempt(const Evaluator& above);

  Vec3 center_;
  double half_, wait_;
  Experience& experience_;
  std::atomic<size_t> seen_{0};
  std::atomic_flag is_begun_, is_tried_;
  std::atomic<double> gain_{0};  // the share of instructions that can be left out
  std::atomic<const Evaluator*> program_{nullptr};
  std::array<std::atomic<Cube*>, 8> children_{};
};

}  // namespace sardf::local
