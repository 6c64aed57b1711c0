#include "povray_gen/samples.hpp"

#include <algorithm>
#include <cmath>

#include "sardf/error.hpp"

namespace sardf::povray {

namespace {

constexpr double whole = 4294967295.0;  // what POV-Ray divides by
// The least and the largest number are left out: a sum of weights may exceed 1 by its rounding.
constexpr double levels = whole - 2;
constexpr size_t rows_at_once = 64;
constexpr size_t samples_at_once = 65536;
constexpr size_t bytes_at_once = 1 << 20;

Interval range_of(std::span<const double> values, Work& work) {
  std::vector<Interval> parts(values.size() / samples_at_once + 1, {infinity, -infinity});
  work.run(values.size(), samples_at_once, [&](size_t first, size_t last) {
    Interval& part = parts[first / samples_at_once];
    for (size_t i = first; i < last; ++i) part = hull(part, values[i]);
  });
  Interval out{infinity, -infinity};
  for (const Interval& part : parts) out = hull(out, part);
  return out;
}

}  // namespace

Samples::Samples(const SampleGrid& grid, std::span<const double> values, Work& work)
    : grid_(grid), codes_(std::make_unique_for_overwrite<uint32_t[]>(values.size())) {
  range_ = range_of(values, work);
  low_ = range_.lo;
  scale_ = (range_.hi - range_.lo) / levels;
  if (!(scale_ < infinity)) throw Error("values from -1e308 to 1e308 cannot be sampled");
  work.run(values.size(), samples_at_once, [&](size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) {
      const double level = scale_ > 0 ? std::round((values[i] - low_) / scale_) : 0;
      codes_[i] = uint32_t(1 + std::clamp(level, 0.0, levels));
    }
  });
  range_.hi += 1e-15 * range_.magnitude();
  slopes_.emplace(grid_, std::span<const uint32_t>(codes_.get(), values.size()), work);
}

double Samples::factor() const { return scale_ * whole; }

Slope Samples::over(const std::array<Interval, 3>& box) const {
  const SampleBounds found = slopes_->over(box, {codes_.get(), grid_.size()});
  constexpr double rounding = 16;
  const auto widened = [](double lo, double hi) {
    return Interval{rounded_down(lo, rounding), rounded_up(hi, rounding)};
  };
  Slope out;
  const double slack = 1e-15 * range_.magnitude();
  out.value = intersect(range_, {low_ + scale_ * (found.codes.lo - 1) - slack,
                                 low_ + scale_ * (found.codes.hi - 1) + slack});
  for (int k = 0; k < 3; ++k) {
    out.partial[k] = widened(scale_ * found.partials[k].lo, scale_ * found.partials[k].hi);
  }
  out.length = rounded_up(scale_ * std::sqrt(found.squares), rounding);
  return out;
}

double Samples::value(const Vec3& at, Vec3* gradient) const {
  std::array<int, 3> cell{};
  Vec3 t{};
  std::array<bool, 3> inside{};
  for (int k = 0; k < 3; ++k) {
    if (!grid_.varies(k)) continue;
    inside[k] = grid_.box[k].contains(at[k]);
    const double place =
        min(max((at[k] - grid_.box[k].lo) / grid_.step(k), 0.0), double(grid_.counts[k] - 1));
    cell[k] = std::clamp(int(place), 0, grid_.counts[k] - 2);
    t[k] = place - cell[k];
  }
  double sum = 0;
  Vec3 slopes{};
  for (int corner = 0; corner < 8; ++corner) {
    std::array<int, 3> p = cell;
    Vec3 weight, change{};
    bool exists = true;
    for (int k = 0; k < 3; ++k) {
      const bool upper = corner >> k & 1;
      if (upper && !grid_.varies(k)) exists = false;
      p[k] += upper;
      weight[k] = upper ? t[k] : 1 - t[k];
      if (inside[k]) change[k] = (upper ? 1 : -1) / grid_.step(k);
    }
    if (!exists) continue;
    const double level = double(codes_[grid_.index(p)]) - 1;
    sum += weight[0] * weight[1] * weight[2] * level;
    for (int k = 0; k < 3; ++k) {
      slopes[k] += change[k] * weight[(k + 1) % 3] * weight[(k + 2) % 3] * level;
    }
  }
  if (gradient) *gradient = scale_ * slopes;
  return low_ + scale_ * sum;
}

// Zero where the function is linear along the axes.
double Samples::bend(size_t index) const {
  const std::array<int, 3> at = grid_.position(index);
  double sum = 0;
  size_t stride = 1;
  for (int k = 0; k < 3; ++k) {
    if (at[k] > 0 && at[k] + 1 < grid_.counts[k]) {
      sum += std::abs(double(codes_[index - stride]) - 2 * double(codes_[index]) +
                      double(codes_[index + stride]));
    }
    stride *= size_t(grid_.counts[k]);
  }
  return sum;
}

std::vector<size_t> Samples::most_bent(size_t count, Work& work) const {
  const size_t nx = size_t(grid_.counts[0]);
  std::vector<std::pair<double, size_t>> worst(grid_.size() / nx);
  work.run(worst.size(), rows_at_once, [&](size_t first, size_t last) {
    for (size_t row = first; row < last; ++row) {
      worst[row] = {-1, 0};
      for (size_t i = row * nx; i < (row + 1) * nx; ++i) {
        const double here = bend(i);
        if (here > worst[row].first) worst[row] = {here, i};
      }
    }
  });
  count = std::min(count, worst.size());
  std::partial_sort(worst.begin(), worst.begin() + std::ptrdiff_t(count), worst.end(),
                    std::greater<>());
  std::vector<size_t> out;
  for (size_t i = 0; i < count; ++i) out.push_back(worst[i].second);
  return out;
}

// POV-Ray's format: three sizes of 16 bits, then the samples, all with the largest byte first.
// Sample i lies at i / size, and behind the last one the first follows again: the layer added at
// the end of each axis keeps that out of our box.
void Samples::write_to(OutputFile& file, const Progress& progress) const {
  std::string bytes;
  for (int k = 0; k < 3; ++k) {
    bytes += char(grid_.stored(k) >> 8);
    bytes += char(grid_.stored(k));
  }
  for (int z = 0; z < grid_.stored(2); ++z) {
    for (int y = 0; y < grid_.stored(1); ++y) {
      for (int x = 0; x < grid_.stored(0); ++x) {
        const uint32_t code =
            codes_[grid_.index({std::min(x, grid_.counts[0] - 1), std::min(y, grid_.counts[1] - 1),
                                std::min(z, grid_.counts[2] - 1)})];
        for (int shift = 24; shift >= 0; shift -= 8) bytes += char(code >> shift);
      }
      if (bytes.size() < bytes_at_once) continue;
      file.write(bytes);
      bytes.clear();
      if (progress && !progress(1)) throw Cancelled();
    }
  }
  file.write(bytes);
}

}  // namespace sardf::povray
