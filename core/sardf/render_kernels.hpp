// What is done with many rays at once; private to core/sardf/render*.cpp. The rules by which rays
// go on are told in render_march.cpp: here they run for the width of an instruction set.
#pragma once

#include <cstdint>

#include "sardf/numbers/lanes.hpp"
#include "sardf/render_table.hpp"

namespace sardf::rendering {

template <class Isa>
struct RayKernelsOf {
  using L = Lanes<Isa>;
  using Mask = typename L::Mask;
  static constexpr size_t width = size_t(L::width);
  static_assert(RaySquare::rays % 16 == 0);

  static L number(RayTable::State state) { return L(double(state)); }
  static Mask is_going(L state) { return state <= number(RayTable::going); }
  static L limited(L a, L low, L high) { return min(max(a, low), high); }

  /// i % edge and i / edge of a square's pixels.
  static L column(size_t first) {
    float all[width];
    for (size_t k = 0; k < width; ++k) all[k] = float((first + k) % RaySquare::edge);
    return L::load(all);
  }
  static L row(size_t first) {
    float all[width];
    for (size_t k = 0; k < width; ++k) all[k] = float((first + k) / RaySquare::edge);
    return L::load(all);
  }

  static void begin(const RayFrame& frame, const RaySquare& square, RayTable& table) {
    const size_t start = table.count;
    const float middle = 0.5f * (RaySquare::edge - 1);
    const L slack(double(frame.range) * depth_slack), tolerance(frame.tolerance);
    for (size_t k = 0; k < RaySquare::rays; k += width) {
      const size_t at = start + k;
      const L column_here = column(k), row_here = row(k);
      const L right = column_here - L(middle), down = row_here - L(middle);
      L enters(square.clear), leaves(frame.range);
      for (size_t axis = 0; axis < 3; ++axis) {
        const L from = L(square.from[axis]) + right * L(square.from_right[axis]) +
                       down * L(square.from_down[axis]);
        const L along = L(square.along[axis]) + right * L(square.along_right[axis]) +
                        down * L(square.along_down[axis]);
        from.store(&table.from[axis][at]);
        along.store(&table.along[axis][at]);
        // A ray that moves less than this has left no box along the axis where it ends.
        const L inverse = L(1.0) / select(abs(along) > L(1e-18), along, L(1e-18));
        const L half(frame.half[axis] + frame.misplaced);
        const L low = (-half - from) * inverse, high = (half - from) * inverse;
        enters = max(enters, min(low, high) - slack);
        leaves = min(leaves, max(low, high) + slack);
      }
      const Mask inside = column_here < L(double(square.right - square.left)) &&
                          row_here < L(double(square.bottom - square.top));
      const L per_length(square.per_length);
      per_length.store(&table.per_length[at]);
      enters.store(&table.clear[at]);
      leaves.store(&table.end[at]);
      min(enters + L(0.5) * tolerance * per_length, leaves).store(&table.trial[at]);
      L(0.0).store(&table.before[at]);
      L(0.0).store(&table.before_value[at]);
      select(inside && enters <= leaves, number(RayTable::going), number(RayTable::missed))
          .store(&table.state[at]);
      (L(double(square.left)) + column_here).store(&table.x[at]);
      (L(double(square.top)) + row_here).store(&table.y[at]);
    }
    table.count = start + RaySquare::rays;
  }

  /// The coordinates along an axis of the places at these depths.
  static L coordinate(const RayFrame& frame, const RayTable& table, size_t axis, size_t i,
                      L depth) {
    const L at = L::load(&table.from[axis][i]) + depth * L::load(&table.along[axis][i]);
    const L half(frame.half[axis]);
    return L(frame.middle[axis]) + limited(at, -half, half);
  }

  static void place(const RayFrame& frame, const RayTable& table, size_t first, size_t n,
                    RayBlock& block) {
    for (size_t k = 0; k < n; k += width) {
      const L trial = L::load(&table.trial[first + k]);
      for (size_t axis = 0; axis < 3; ++axis)
        coordinate(frame, table, axis, first + k, trial).store(&block.xyz[axis][k]);
    }
  }

  static size_t use(const RayFrame& frame, RayTable& table, size_t first, size_t n,
                    const float* value, const float* reach) {
    float still[width];
    L going(0.0);
    for (size_t k = 0; k < n; k += width) {
      const L known = reach ? L::load(reach + k) : L(0.0);
      going = going + use_samples(frame, table, first + k, L::load(value + k), known, reach);
    }
    going.store(still);
    size_t sum = 0;
    for (const float lane : still) sum += size_t(lane);
    return sum;
  }

  /// 1 for rays that are still going, 0 for others.
  static L use_samples(const RayFrame& frame, RayTable& table, size_t i, L value, L known,
                       bool knows) {
    const L state = L::load(&table.state[i]), trial = L::load(&table.trial[i]);
    const L clear = L::load(&table.clear[i]), end = L::load(&table.end[i]);
    const L before = L::load(&table.before[i]), before_value = L::load(&table.before_value[i]);
    const L per_length = L::load(&table.per_length[i]);
    const L error(frame.error), tolerance = L(frame.tolerance) * per_length;
    const L surest = min(clear + tolerance, end), nearest = min(clear + L(0.5) * tolerance, end);
    const L reach =
        (knows ? known : ((-value - error) * L(frame.per_slope) - L(frame.misplaced)) * per_length);
    const Mask active = is_going(state), guessed = trial > surest;
    const Mask outside = value < -error && reach > L(0.0);
    const Mask counts = outside && (!guessed || trial - reach <= surest);
    // A sample that may lie in the solid ends the ray unless it was a guess, or is not sure and the
    // tolerance lets one look farther.
    const Mask is_in = value > error;
    const Mask ends = !outside && !guessed && (is_in || trial >= surest);
    const L slack(double(frame.range) * depth_slack);
    const L new_clear = select(counts, max(clear, trial + reach - slack), clear);
    const L next = next_trial({trial, value, before, before_value, reach, tolerance, end},
                              min(new_clear + L(0.5) * tolerance, end));
    const L other = select(guessed, nearest, surest);
    const auto put = [&](RayTable::Row& row, Mask where, L what, L otherwise) {
      select(active && where, what, otherwise).store(&row[i]);
    };
    put(table.before, counts, trial, before);
    put(table.before_value, counts, value, before_value);
    put(table.clear, counts, new_clear, clear);
    put(table.beyond, ends, trial, L::load(&table.beyond[i]));
    put(table.beyond_value, ends, value, L::load(&table.beyond_value[i]));
    put(table.trial, !ends, select(counts, next, other), trial);
    const L found = select(is_in, number(RayTable::met), number(RayTable::unsure));
    const Mask past = counts && new_clear >= end;
    const L now =
        select(active, select(ends, found, select(past, number(RayTable::missed), state)), state);
    now.store(&table.state[i]);
    return select(is_going(now), L(1.0), L(0.0));
  }

  struct Samples {
    L trial, value, before, before_value, reach, tolerance, end;
  };
  /// next_trial of render_march.cpp.
  static L next_trial(const Samples& s, L surest) {
    const L depth = -s.value;
    const L share = (-s.before_value - depth) * s.reach / ((s.trial - s.before) * depth);
    const L step = L(2 * caution) * s.reach / (L(1.0) + limited(share, L(-0.5), L(1.0)));
    const L guess = s.trial + step;
    const Mask helps = s.before_value < L(0.0) && s.reach > L(0.0) &&
                       guess > s.trial + L(least_gain) * s.reach + s.tolerance && guess < s.end;
    return select(helps, guess, surest);
  }

  static void copy(const RayTable& from, RayTable::State which, RayTable& to) {
    const size_t at = &from == &to ? 0 : to.count;
    to.count = at + copy_rows(from, which, to, at);
  }

#if defined(__AVX512F__)
  /// Of whole lanes the chosen ones move together. What is written behind them is written again, or
  /// has no meaning.
  static size_t copy_rows(const RayTable& from, RayTable::State which, RayTable& to, size_t at) {
    static_assert(width == 16);
    std::array<__mmask16, RayTable::room / width> chosen;
    size_t copied = 0;
    const size_t groups = (from.count + width - 1) / width;
    for (size_t g = 0; g < groups; ++g) {
      const L state = L::load(&from.state[g * width]);
      const Mask is = state <= number(which) && state >= number(which);
      const size_t left = from.count - g * width;
      chosen[g] = left < width ? __mmask16(is.bits & ((1u << left) - 1)) : is.bits;
      copied += size_t(__builtin_popcount(chosen[g]));
    }
    if (copied == 0) return 0;
    RayTable::for_rows(from, to, [&](const RayTable::Row& row, RayTable::Row& other) {
      float* next = &other[at];
      for (size_t g = 0; g < groups; ++g) {
        const __m512 all = _mm512_loadu_ps(&row[g * width]);
        _mm512_storeu_ps(next, _mm512_maskz_compress_ps(chosen[g], all));
        next += __builtin_popcount(chosen[g]);
      }
    });
    return copied;
  }
#else
  static size_t copy_rows(const RayTable& from, RayTable::State which, RayTable& to, size_t at) {
    std::array<uint16_t, RayTable::room> chosen;
    size_t copied = 0;
    for (size_t i = 0; i < from.count; ++i) {
      chosen[copied] = uint16_t(i);
      copied += from.state_of(i) == which;
    }
    RayTable::for_rows(from, to, [&](const RayTable::Row& row, RayTable::Row& other) {
      for (size_t k = 0; k < copied; ++k) other[at + k] = row[chosen[k]];
    });
    return copied;
  }
#endif

  static void place_aside(const RayFrame& frame, RayTable& table, size_t first, size_t n,
                          float aside, size_t behind, RayBlock& block) {
    for (size_t k = 0; k < n; k += width) {
      const size_t i = first + k;
      const L before_value = L::load(&table.before_value[i]);
      const L inside = L::load(&table.beyond[i]), inside_value = L::load(&table.beyond_value[i]);
      const L outside =
          select(before_value < L(0.0), L::load(&table.before[i]), L::load(&table.clear[i]));
      const L crossing =
          outside - before_value * (inside - outside) / (inside_value - before_value);
      const Mask is_within = before_value < L(0.0) && crossing > outside && crossing < inside;
      const L trial = select(is_within, crossing, L(0.5) * (outside + inside));
      trial.store(&table.trial[i]);
      const L way = L(aside) * L::load(&table.per_length[i]);
      for (size_t axis = 0; axis < 3; ++axis) {
        coordinate(frame, table, axis, i, trial - way).store(&block.xyz[axis][k]);
        coordinate(frame, table, axis, i, trial + way).store(&block.xyz[axis][behind + k]);
      }
    }
  }

  static void mix(const RayFrame& frame, RayTable& table, size_t first, size_t n, float equal,
                  size_t behind, RayBlock& block) {
    const L error(frame.error);
    for (size_t k = 0; k < n; k += width) {
      Mask known = L::load(block.value + k) < -error && L::load(block.value + behind + k) > error;
      for (auto& channel : block.channels) {
        const L one = L::load(channel + k), other = L::load(channel + behind + k);
        known = known && abs(one - other) <= L(equal);
        limited(L(0.5) * (one + other), L(0.0), L(1.0)).store(channel + k);
      }
      const L trial = L::load(&table.trial[first + k]);
      select(known, trial, L(std::nan(""))).store(&table.trial[first + k]);
    }
  }

  static constexpr RayKernels all_kernels{&begin, &place, &use, &copy, &place_aside, &mix};
};

}  // namespace sardf::rendering
