// Moving points that are almost on a solid's surface onto it: with their triangle's other points,
// by steps along its directions, at last by Newton's steps of their own. A way counts only where
// the field's value at its end is within the tolerance; else the point begins anew.

#include <cmath>

#include "sardf/bake_stages.hpp"

namespace sardf::baking {
namespace {

constexpr size_t block_size = Evaluator::block_size;
constexpr int steps = 3;         // along a point's own gradients
constexpr int guided_steps = 2;  // along the directions of its triangle
/// Smallest squared cosine between the gradient and the face's normal: 45 degrees. Beyond, the
/// nearest zero set is that of another face.
constexpr float aligned = 0.5f;

using Values = std::array<float, block_size>;
using L = Lanes<Baseline>;

/// The points of whole rows of a tile after those on bent triangles have been moved.
class BentPoints {
 public:
  /// Of the points [first, first + n), with the runs of theirs.
  void move(const TilePoints& points, const Guides& guides, std::span<const TexelRun> runs,
            size_t first, size_t n) {
    for (size_t axis = 0; axis < 3; ++axis)
      std::copy_n(&points.point[axis][first], n, at[axis].begin());
    for (const TexelRun& run : runs) {
      const uint32_t bend = guides.bend_of[run.on];
      if (bend != Guides::none) move(points, guides.bends[bend], run, first);
    }
  }

  std::array<std::array<float, block_size + L::width>, 3> at;

 private:
  /// Whole lanes are moved: what was behind the run is put back.
  void move(const TilePoints& points, const Bend& bend, const TexelRun& run, size_t first) {
    const Triangle& on = points.triangles[run.on];
    const std::array<L, Bend::degree + 1> factor = in_row(bend, run.y - on.y0);
    std::array<std::array<L, 3>, Bend::degree + 1> by;
    for (size_t p = 0; p <= Bend::degree; ++p)
      for (size_t axis = 0; axis < 3; ++axis) by[p][axis] = L(double(factor[p].v[axis]));
    L x = L(double(run.x - on.x0)) + L(L::Values{0, 1, 2, 3});
    const size_t to = run.first - first;
    for (size_t i = 0; i < run.count; i += L::width, x = x + L(double(L::width))) {
      std::array<L, 3> sum = by[Bend::degree];
      for (size_t p = Bend::degree; p-- > 0;)
        for (size_t axis = 0; axis < 3; ++axis) sum[axis] = sum[axis] * x + by[p][axis];
      for (size_t axis = 0; axis < 3; ++axis)
        (L::load(&points.point[axis][run.first + i]) + sum[axis]).store(&at[axis][to + i]);
    }
    for (size_t axis = 0; axis < 3; ++axis)
      L::load(&points.point[axis][run.first + run.count]).store(&at[axis][to + run.count]);
  }

  /// The factors of x^p in a row.
  static std::array<L, Bend::degree + 1> in_row(const Bend& bend, double row) {
    const L y(row);
    std::array<L, Bend::degree + 1> result;
    for (size_t p = 0; p <= Bend::degree; ++p) {
      L sum = bend.factor[p][Bend::degree - p];
      for (size_t q = Bend::degree - p; q-- > 0;) sum = sum * y + bend.factor[p][q];
      result[p] = sum;
    }
    return result;
  }
};

/// The points of a tile that are on their way, packed: most points are where they belong from the
/// start, or after one step.
class Movement {
 public:
  Movement(const LocalEvaluator& solid, TilePoints& points, float tolerance)
      : solid_(solid), points_(points), tolerance_(tolerance) {}

  void run() {
    thread_local Guides guides;
    find_guides(solid_, points_, tolerance_, guides);
    find_distant(guides);
    step_with_triangles(guides);
    for (int step = 0; step < steps && count_ > 0; ++step) {
      size_t kept = 0;
      for (size_t first = 0; first < count_; first += block_size)
        kept = take_step(first, std::min(block_size, count_ - first), kept);
      count_ = kept;
    }
    for (size_t k = 0; k < count_; ++k) settle(k);
  }

 private:
  /// Moves the points on bent triangles, and finds the points that are distant then: those go on
  /// from where they were.
  void find_distant(const Guides& guides) {
    auto run = points_.runs.begin();
    for_blocks(points_, block_size, [&](int first_row, int last_row) {
      const auto begin = run;
      while (run != points_.runs.end() && run->y < last_row) ++run;
      const size_t first = points_.start[size_t(first_row)];
      const size_t n = points_.start[size_t(last_row)] - first;
      const bool bent = std::any_of(begin, run, [&](const TexelRun& each) {
        return guides.bend_of[each.on] != Guides::none;
      });
      if (bent)
        find_distant_bent(guides, {begin, run}, first, n);
      else
        find_distant(first, n);
    });
    find_distant_again();
  }

  /// In a block where no triangle is bent.
  void find_distant(size_t first, size_t n) {
    Values value;
    evaluate(&points_.point[0][first], &points_.point[1][first], &points_.point[2][first], n,
             value);
    for_distant(value, n, [&](size_t i) { append(first + i, value[i]); });
  }

  void find_distant_bent(const Guides& guides, std::span<const TexelRun> runs, size_t first,
                         size_t n) {
    bent_.move(points_, guides, runs, first, n);
    Values value;
    evaluate(bent_.at[0].data(), bent_.at[1].data(), bent_.at[2].data(), n, value);
    for_distant(value, n, [&](size_t i) {
      again_[again_count_++] = static_cast<uint16_t>(first + i);
      for (size_t axis = 0; axis < 3; ++axis) bent_.at[axis][i] = points_.point[axis][first + i];
    });
    for (size_t axis = 0; axis < 3; ++axis)
      std::copy_n(bent_.at[axis].begin(), n, &points_.point[axis][first]);
  }

  /// Of the points that were distant with the other points of their triangle, those that are
  /// distant where they were before.
  void find_distant_again() {
    std::array<Values, 3> at;
    Values value;
    for (size_t first = 0; first < again_count_; first += block_size) {
      const size_t n = std::min(block_size, again_count_ - first);
      for (size_t axis = 0; axis < 3; ++axis)
        for (size_t i = 0; i < n; ++i) at[axis][i] = points_.point[axis][again_[first + i]];
      evaluate(at[0].data(), at[1].data(), at[2].data(), n, value);
      for_distant(value, n, [&](size_t i) { append(again_[first + i], value[i]); });
    }
  }

  void evaluate(const float* x, const float* y, const float* z, size_t n, Values& value) const {
    float* out = value.data();
    solid_.block(x, y, z, n, &out);
  }

  /// work(i) for the values that are not within the tolerance.
  template <class Work>
  void for_distant(const Values& value, size_t n, Work work) const {
    size_t i = 0;
    for (; i + L::width <= n; i += L::width) {
      if (all(abs(L::load(&value[i])) <= L(double(tolerance_)))) continue;
      for (size_t k = i; k < i + L::width; ++k)
        if (!(std::abs(value[k]) <= tolerance_)) work(k);
    }
    for (; i < n; ++i)
      if (!(std::abs(value[i]) <= tolerance_)) work(i);
  }

  /// Moves points along the directions of their triangles. Those that do not get within the
  /// tolerance so go on from where they were.
  void step_with_triangles(const Guides& guides) {
    size_t kept = 0;
    for (size_t first = 0; first < count_; first += block_size)
      kept = step_with_triangles(guides, first, std::min(block_size, count_ - first), kept);
    count_ = kept;
  }

  /// The same of moving points [first, first + n). Those that go on are packed at `kept`; the new
  /// `kept`.
  size_t step_with_triangles(const Guides& guides, size_t first, size_t n, size_t kept) {
    std::array<Values, 3> at, along;
    Values value;
    std::array<uint16_t, block_size> of;
    size_t count = 0;
    for (size_t k = first; k < first + n; ++k) {
      const uint32_t on = points_.on[place_[k]];
      const uint32_t directions =
          on < guides.directions_of.size() ? guides.directions_of[on] : Guides::none;
      if (directions == Guides::none) continue;
      const std::array<float, 3> by =
          guides.directions[directions].at({at_[0][k], at_[1][k], at_[2][k]});
      for (size_t axis = 0; axis < 3; ++axis) {
        at[axis][count] = at_[axis][k];
        along[axis][count] = by[axis];
      }
      value[count] = value_[k];
      of[count++] = static_cast<uint16_t>(k);
    }
    for (int step = 0; step < guided_steps && count > 0; ++step) {
      for (size_t axis = 0; axis < 3; ++axis)
        for (size_t i = 0; i < count; ++i) at[axis][i] -= value[i] * along[axis][i];
      evaluate(at[0].data(), at[1].data(), at[2].data(), count, value);
    }
    std::array<bool, block_size> arrived{};
    for (size_t i = 0; i < count; ++i) {
      const size_t place = place_[of[i]];
      const std::array<float, 3> to{at[0][i], at[1][i], at[2][i]};
      if (!(std::abs(value[i]) <= tolerance_) || !is_within_limit(place, to)) continue;
      for (size_t axis = 0; axis < 3; ++axis) points_.point[axis][place] = to[axis];
      arrived[of[i] - first] = true;
    }
    for (size_t k = first; k < first + n; ++k)
      if (!arrived[k - first]) keep(k, kept++);
    return kept;
  }

  bool is_within_limit(size_t place, const std::array<float, 3>& to) const {
    float moved = 0;
    for (size_t axis = 0; axis < 3; ++axis) {
      const float d = to[axis] - points_.point[axis][place];
      moved += d * d;
    }
    const float limit = points_.surfaces[points_.on[place]].limit;
    return moved <= limit * limit;
  }

  /// Packs moving point k at `to`.
  void keep(size_t k, size_t to) {
    place_[to] = place_[k];
    start_[to] = start_[k];
    value_[to] = value_[k];
    for (size_t axis = 0; axis < 3; ++axis) at_[axis][to] = at_[axis][k];
  }

  void append(size_t place, float value) {
    // A NaN stays where it is, as does a point that may not be moved at all.
    if (std::isnan(value) || points_.surfaces[points_.on[place]].limit == 0) return;
    place_[count_] = static_cast<uint16_t>(place);
    for (size_t axis = 0; axis < 3; ++axis) at_[axis][count_] = points_.point[axis][place];
    start_[count_] = value_[count_] = value;
    ++count_;
  }

  /// Newton's step of moving points [first, first + n). Those that go on are packed at `kept`;
  /// the new `kept`.
  size_t take_step(size_t first, size_t n, size_t kept) {
    Values value;
    std::array<Values, 3> gradient;
    float* const by[3] = {gradient[0].data(), gradient[1].data(), gradient[2].data()};
    solid_.gradient_block(&at_[0][first], &at_[1][first], &at_[2][first], n, value.data(), by);
    const size_t begin = kept;
    for (size_t i = 0; i < n; ++i) {
      const size_t k = first + i;
      std::array<float, 3> to{gradient[0][i], gradient[1][i], gradient[2][i]};
      const Step step = find_step(k, to);
      if (step == Step::none) settle(k);
      if (step != Step::taken) continue;
      place_[kept] = place_[k];
      start_[kept] = start_[k];
      for (size_t axis = 0; axis < 3; ++axis) at_[axis][kept] = to[axis];
      ++kept;
    }
    float* out = &value_[begin];
    if (kept > begin)
      solid_.block(&at_[0][begin], &at_[1][begin], &at_[2][begin], kept - begin, &out);
    size_t going = begin;
    for (size_t k = begin; k < kept; ++k) {
      if (!(std::abs(value_[k]) > tolerance_)) {
        settle(k);
        continue;
      }
      keep(k, going++);
    }
    return going;
  }

  enum class Step { taken, none, too_far };
  /// Where a step along the gradient leads, in place of the gradient.
  Step find_step(size_t k, std::array<float, 3>& gradient) const {
    const size_t p = place_[k];
    const PointSurface& on = points_.surfaces[points_.on[p]];
    float squared = 0, cosine = 0;
    for (size_t axis = 0; axis < 3; ++axis) {
      squared += gradient[axis] * gradient[axis];
      cosine += gradient[axis] * on.normal[axis];
    }
    if (!(cosine * cosine >= aligned * squared) || !(squared > 0)) return Step::none;
    const float scale = value_[k] / squared;
    for (size_t axis = 0; axis < 3; ++axis) gradient[axis] = at_[axis][k] - scale * gradient[axis];
    return is_within_limit(p, gradient) ? Step::taken : Step::too_far;
  }

  /// A point stays where it came unless it was nearer before.
  void settle(size_t k) {
    if (!(std::abs(value_[k]) <= std::abs(start_[k]))) return;
    for (size_t axis = 0; axis < 3; ++axis) points_.point[axis][place_[k]] = at_[axis][k];
  }

  const LocalEvaluator& solid_;
  TilePoints& points_;
  float tolerance_;
  BentPoints bent_;
  std::array<uint16_t, tile_texels> again_;
  size_t again_count_ = 0;
  size_t count_ = 0;
  std::array<uint16_t, tile_texels> place_;
  std::array<std::array<float, tile_texels>, 3> at_;
  std::array<float, tile_texels> value_, start_;  // of the field, here and at the start
};

}  // namespace

void project(const LocalEvaluator& solid, TilePoints& points, float tolerance) {
  Movement(solid, points, tolerance).run();
}

}  // namespace sardf::baking
