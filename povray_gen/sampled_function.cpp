#include "povray_gen/sampled_function.hpp"

#include <atomic>

#include "povray_gen/names.hpp"

namespace sardf::povray {

namespace {

OperationInfo sampled_info(OperationInfo info) {
  info.name += "_sampled";
  return info;
}

// Equal operations share a node, which would keep the density file of another scene: no two of
// these are equal.
std::vector<double> serial_number() {
  static std::atomic<int64_t> made{0};
  return {double(++made)};
}

}  // namespace

SampledFunction::SampledFunction(OperationPointer exact, std::shared_ptr<const Samples> samples,
                                 const SampleError& error, std::string file)
    : DataOperation(sampled_info(exact->info()), serial_number()),
      exact_(std::move(exact)),
      samples_(std::move(samples)),
      error_(error),
      file_(std::move(file)) {}

std::string SampledFunction::description() const {
  std::string out = exact_->info().name + ": ";
  for (int k = 0; k < 3; ++k) {
    out += (k ? " x " : "") + std::to_string(samples_->grid().counts[k]);
  }
  out += " samples in " + file_ + "; differs from the exact function by at most ";
  if (error_.proven < infinity) out += bound_text(error_.proven) + " (proven), ";
  out += bound_text(error_.measured) + " (measured at " + std::to_string(error_.points) + " points";
  if (error_.measured > error_.aimed) out += "; " + bound_text(error_.aimed) + " was aimed at";
  return out + ")";
}

Vec3 SampledFunction::point(const double* const* in, size_t i) const {
  Vec3 out{};
  for (int k = 0; k < info().arity; ++k) out[k] = in[k][i];
  return out;
}

void SampledFunction::evaluate(const double* const* in, double* out, size_t n) const {
  for (size_t i = 0; i < n; ++i) out[i] = samples_->value(point(in, i), nullptr);
}

void SampledFunction::partials(const double* const* in, double* out, double* const* partial,
                               size_t n) const {
  for (size_t i = 0; i < n; ++i) {
    Vec3 gradient;
    out[i] = samples_->value(point(in, i), &gradient);
    for (int k = 0; k < info().arity; ++k) partial[k][i] = gradient[k];
  }
}

Slope SampledFunction::sampled_over(const Interval* in) const {
  std::array<Interval, 3> box{};
  for (int k = 0; k < info().arity; ++k) box[size_t(k)] = in[k];
  Slope out = samples_->over(box);
  if (!(error_.proven < infinity)) return out;
  std::array<Interval, max_arity> inside;
  for (int k = 0; k < info().arity; ++k) {
    const Interval& grid = samples_->grid().box[size_t(k)];
    inside[k] = {min(max(in[k].lo, grid.lo), grid.hi), min(max(in[k].hi, grid.lo), grid.hi)};
  }
  const Interval error{-error_.proven, error_.proven};
  out.value = intersect(out.value, exact_->interval(inside.data()) + error);
  return out;
}

Interval SampledFunction::interval(const Interval* in) const { return sampled_over(in).value; }

Slope SampledFunction::slope(const Slope* in) const {
  std::array<Interval, max_arity> values;
  for (int k = 0; k < info().arity; ++k) values[k] = in[k].value;
  const Slope sampled = sampled_over(values.data());
  const std::span partials(sampled.partial.data(), size_t(info().arity));
  return slope_from(in, sampled.value, partials, sampled.length);
}

}  // namespace sardf::povray
