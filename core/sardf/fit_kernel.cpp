#include "sardf/fit_kernel.hpp"

#include <algorithm>

namespace sardf {

namespace {

// to[a][o][b] = sum over i of table[i][o] * from[a][i][b].
void contract_any(const double* table, int in, int out, int after, const double* from, double* to,
                  int before) {
  for (int a = 0; a < before; ++a) {
    const double* part = from + a * in * after;
    double* sums = to + a * out * after;
    std::fill_n(sums, out * after, 0.0);
    for (int i = 0; i < in; ++i) {
      for (int o = 0; o < out; ++o) {
        const double by = table[i * out + o];
        for (int b = 0; b < after; ++b) sums[o * after + b] += by * part[i * after + b];
      }
    }
  }
}

// The same for 4 and 4, with sums that stay in registers.
template <int After>
void contract_four(const double* table, const double* from, double* to, int before) {
  for (int a = 0; a < before; ++a, from += 4 * After, to += 4 * After) {
    for (int o = 0; o < 4; ++o) {
      double sums[After] = {};
      for (int i = 0; i < 4; ++i) {
        for (int b = 0; b < After; ++b) sums[b] += table[4 * i + o] * from[After * i + b];
      }
      for (int b = 0; b < After; ++b) to[After * o + b] = sums[b];
    }
  }
}
template <>
void contract_four<1>(const double* table, const double* from, double* to, int before) {
  for (int a = 0; a < before; ++a, from += 4, to += 4) {
    double sums[4] = {};
    for (int i = 0; i < 4; ++i) {
      for (int o = 0; o < 4; ++o) sums[o] += table[4 * i + o] * from[i];
    }
    std::copy_n(sums, 4, to);
  }
}

}  // namespace

FitKernel::Table FitKernel::Table::transposed() const {
  Table made{outputs, inputs, std::vector<double>(entries.size())};
  for (int i = 0; i < inputs; ++i) {
    for (int o = 0; o < outputs; ++o)
      made.entries[size_t(o * inputs + i)] = entries[size_t(i * outputs + o)];
  }
  return made;
}

FitKernel::FitKernel(const SplineGrid& grid, int points) : weights_(1), points_(1) {
  const GaussRule rule = gauss_rule(points);
  for (int k = 0; k < 3; ++k) {
    const int n = grid.degrees[size_t(k)] + 1, q = k < grid.dimensions ? points : 1;
    Axis& axis = axes_[k];
    axis.value = axis.slope = {n, q, std::vector<double>(size_t(n * q))};
    for (int p = 0; p < q; ++p) {
      double value[most_spline_weights], slope[most_spline_weights];
      const double t = k < grid.dimensions ? rule.at[size_t(p)] : 0.5;
      spline_weights_and_slopes(grid.degrees[size_t(k)], t, value, slope);
      for (int j = 0; j < n; ++j) {
        axis.value.entries[size_t(j * q + p)] = value[j];
        axis.slope.entries[size_t(j * q + p)] = slope[j] * grid.per_length(k);
      }
    }
    axis.value_back = axis.value.transposed();
    axis.slope_back = axis.slope.transposed();
    for (const auto& [a, b] : {std::pair{&axis.value_back, &axis.value_back},
                               {&axis.value_back, &axis.slope_back},
                               {&axis.slope_back, &axis.slope_back}}) {
      Table product = *a;
      for (size_t i = 0; i < product.entries.size(); ++i) product.entries[i] *= b->entries[i];
      axis.products.push_back(std::move(product));
    }
    weights_ *= size_t(n);
    points_ *= size_t(q);
  }
}

void FitKernel::contract(const Table& t, const double* from, double* to, int before, int after) {
  const double* entries = t.entries.data();
  const bool four = t.inputs == 4 && t.outputs == 4;
  if (four && after == 16) return contract_four<16>(entries, from, to, before);
  if (four && after == 4) return contract_four<4>(entries, from, to, before);
  if (four && after == 1) return contract_four<1>(entries, from, to, before);
  contract_any(entries, t.inputs, t.outputs, after, from, to, before);
}

void FitKernel::apply(const Table& table, const double* from, double* to, int before, int after,
                      bool add) {
  if (!add) return contract(table, from, to, before, after);
  thread_local std::vector<double> sums;
  const size_t n = size_t(before * table.outputs * after);
  sums.resize(n);
  contract(table, from, sums.data(), before, after);
  for (size_t i = 0; i < n; ++i) to[i] += sums[i];
}

/// Between the axes: contracted along x, and along x and y.
struct FitKernel::Buffers {
  std::vector<double> x[2], xy[3];
  Buffers& sized(size_t one, size_t two) {
    for (std::vector<double>& each : x) each.resize(one);
    for (std::vector<double>& each : xy) each.resize(two);
    return *this;
  }
  static Buffers& of_thread(size_t one, size_t two) {
    thread_local Buffers buffers;
    return buffers.sized(one, two);
  }
};

void FitKernel::forward(const double* c, double* fields) const {
  const auto& [x, y, z] = axes_;
  const int nx = x.value.outputs, ny = y.value.outputs;
  const int py = y.value.inputs, pz = z.value.inputs;
  Buffers& b = Buffers::of_thread(size_t(nx * py * pz), size_t(nx * ny * pz));
  apply(x.value, c, b.x[0].data(), 1, py * pz);
  apply(x.slope, c, b.x[1].data(), 1, py * pz);
  apply(y.value, b.x[0].data(), b.xy[0].data(), nx, pz);
  apply(y.value, b.x[1].data(), b.xy[1].data(), nx, pz);
  apply(y.slope, b.x[0].data(), b.xy[2].data(), nx, pz);
  apply(z.value, b.xy[0].data(), fields, nx * ny, 1);
  apply(z.value, b.xy[1].data(), fields + points_, nx * ny, 1);
  apply(z.value, b.xy[2].data(), fields + 2 * points_, nx * ny, 1);
  apply(z.slope, b.xy[0].data(), fields + 3 * points_, nx * ny, 1);
}

void FitKernel::backward(const double* fields, double* c) const {
  const auto& [x, y, z] = axes_;
  const int nx = x.value.outputs, ny = y.value.outputs;
  const int py = y.value.inputs, pz = z.value.inputs;
  Buffers& b = Buffers::of_thread(size_t(nx * py * pz), size_t(nx * ny * pz));
  apply(z.value_back, fields, b.xy[0].data(), nx * ny, 1);
  apply(z.slope_back, fields + 3 * points_, b.xy[0].data(), nx * ny, 1, true);
  apply(z.value_back, fields + points_, b.xy[1].data(), nx * ny, 1);
  apply(z.value_back, fields + 2 * points_, b.xy[2].data(), nx * ny, 1);
  apply(y.value_back, b.xy[0].data(), b.x[0].data(), nx, pz);
  apply(y.slope_back, b.xy[2].data(), b.x[0].data(), nx, pz, true);
  apply(y.value_back, b.xy[1].data(), b.x[1].data(), nx, pz);
  apply(x.value_back, b.x[0].data(), c, 1, py * pz, true);
  apply(x.slope_back, b.x[1].data(), c, 1, py * pz, true);
}

void FitKernel::values(const double* c, double* values) const {
  const auto& [x, y, z] = axes_;
  const int nx = x.value.outputs, ny = y.value.outputs;
  const int py = y.value.inputs, pz = z.value.inputs;
  Buffers& b = Buffers::of_thread(size_t(nx * py * pz), size_t(nx * ny * pz));
  apply(x.value, c, b.x[0].data(), 1, py * pz);
  apply(y.value, b.x[0].data(), b.xy[0].data(), nx, pz);
  apply(z.value, b.xy[0].data(), values, nx * ny, 1);
}

void FitKernel::values_backward(const double* values, double* c) const {
  add_squares(-1, -1, values, c);
}

void FitKernel::add_squares(int a, int b, const double* by, double* c) const {
  const Table* tables[3];
  for (int k = 0; k < 3; ++k) {
    tables[k] = a < 0 ? &axes_[k].value_back
                      : &axes_[k].products[size_t(int(a == k + 1) + int(b == k + 1))];
  }
  const int nx = axes_[0].value.outputs, ny = axes_[1].value.outputs;
  const int py = axes_[1].value.inputs, pz = axes_[2].value.inputs;
  Buffers& to = Buffers::of_thread(size_t(nx * py * pz), size_t(nx * ny * pz));
  apply(*tables[2], by, to.xy[0].data(), nx * ny, 1);
  apply(*tables[1], to.xy[0].data(), to.x[0].data(), nx, pz);
  apply(*tables[0], to.x[0].data(), c, 1, py * pz, true);
}

}  // namespace sardf
