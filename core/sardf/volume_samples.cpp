#include "sardf/volume_samples.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>

#include "sardf/error.hpp"
#include "sardf/pulse.hpp"
#include "sardf/short_number.hpp"
#include "sardf/shorten.hpp"
#include "sardf/volume_blocks.hpp"

namespace sardf {

namespace {

using namespace volume;

constexpr int most_along = 2048;
constexpr size_t most_samples = size_t(1) << 28;

// Samples along the edge of the blocks whose programs others start from.
constexpr int large_edge = 4 * block_edge;
// Programs of blocks are shortened where they are longer than this, and those of their octants
// where they are longer than that: less costs less than finding out (bench/bench_volume.cpp).
constexpr size_t long_for_block = 8, long_for_octant = 64;
// So few samples are not worth a program of their own.
constexpr size_t few_samples = 256;

/// Samples on their way through an evaluator.
struct Batch {
  static constexpr size_t capacity = Evaluator::block_size;
  float x[capacity], y[capacity], z[capacity];
  size_t at[capacity];
  size_t n = 0;
};

/// What the blocks add to the result's figures.
struct Figures {
  float steepness = 0;
  Interval range{infinity, -infinity};
};

class Sampler {
 public:
  Sampler(const VolumeSampling& sampling, const Progress& progress)
      : grid_(sampling.grid),
        pulse_(progress),
        colored_(sampling.colored),
        all_{{0, 0, 0}, grid_.counts},
        blocks_(all_, block_edge),
        large_(all_, large_edge) {
    for (int axis = 0; axis < 3; ++axis) {
      for (int i = 0; i < grid_.counts[axis]; ++i) at_[axis].push_back(float(grid_.at(axis, i)));
    }
    samples_.field = std::make_unique_for_overwrite<float[]>(grid_.size());
    limit_ = float(grid_.box.diagonal());
    if (colored_ == Colored::nothing) return;
    samples_.colors = std::make_unique_for_overwrite<float[]>(4 * grid_.size());
  }

  void sample_field(const Evaluator& solid) {
    pulse_.stage(0.5);
    for_blocks(solid,
               [&](const Evaluator& program, size_t i) { sample_block(program, blocks_[i]); });
  }

  void sample_colors(const Evaluator& color) {
    pulse_.stage(1);
    std::vector<Figures> figures(blocks_.size());
    for_blocks(color, [&](const Evaluator& program, size_t i) {
      figures[i].steepness = steepness_in(grid_, samples_.field.get(), blocks_[i]);
      if (samples_.colors) figures[i].range = color_block(program, blocks_[i]);
      count(blocks_[i].size());
    });
    for (const Figures& f : figures) {
      samples_.steepness = std::max(samples_.steepness, double(f.steepness));
      samples_.range = {std::min(samples_.range.lo, f.range.lo),
                        std::max(samples_.range.hi, f.range.hi)};
    }
    samples_.steepness *= 1 + 0x1p-20;  // rounding
  }

  VolumeSamples result() { return std::move(samples_); }

 private:
  // work(program, block) on all threads, the program shortened for the large block around it.
  template <class Work>
  void for_blocks(const Evaluator& program, const Work& work) {
    done_ = 0;
    std::vector<std::optional<Evaluator>> shorter(large_.size());
    tbb::parallel_for(size_t(0), large_.size(), [&](size_t i) {
      pulse_(0);
      shorter[i] = shortened(program, large_[i], long_for_block);
    });
    tbb::parallel_for(size_t(0), blocks_.size(), [&](size_t i) {
      const auto& large = shorter[large_.number(blocks_[i].first)];
      work(large ? *large : program, i);
    });
  }

  // None: the program is as short as it gets.
  std::optional<Evaluator> shortened(const Evaluator& program, const Block& block,
                                     size_t long_enough) const {
    const size_t steps = program.tape().instructions().size();
    if (steps <= long_enough) return {};
    Evaluator shorter = Shortening(program, box(block)).shortened();
    if (shorter.tape().instructions().size() >= steps) return {};
    return shorter;
  }

  // Around the samples, as floats.
  BoundingBox box(const Block& block) const {
    BoundingBox box;
    for (int axis = 0; axis < 3; ++axis) {
      box.lo[axis] = at_[axis][size_t(block.first[axis])];
      box.hi[axis] = at_[axis][size_t(block.last[axis]) - 1];
    }
    return box;
  }

  void sample_block(const Evaluator& above, const Block& block) {
    const std::optional<Evaluator> shorter = shortened(above, block, long_for_block);
    const Evaluator& here = shorter ? *shorter : above;
    if (here.tape().instructions().size() <= long_for_octant) {
      sample_all(here, block);
      return;
    }
    const Blocks octants(block, block_edge / 2);
    for (size_t k = 0; k < octants.size(); ++k) {
      const std::optional<Evaluator> own = shortened(here, octants[k], long_for_octant);
      sample_all(own ? *own : here, octants[k]);
    }
  }

  void sample_all(const Evaluator& program, const Block& block) {
    Batch batch;
    const auto flush = [&] {
      float value[Batch::capacity];
      float* out = value;
      program.block(batch.x, batch.y, batch.z, batch.n, &out);
      for (size_t i = 0; i < batch.n; ++i) {
        // Not std::clamp, which lets NaN through.
        const float v = value[i] > -limit_ ? value[i] : -limit_;
        samples_.field[batch.at[i]] = v < limit_ ? v : limit_;
      }
      count(batch.n);
      batch.n = 0;
    };
    for_samples(grid_, block, [&](const Index& at, size_t to) { add(at, to, batch, flush); });
    if (batch.n > 0) flush();
  }

  template <class Flush>
  void add(const Index& at, size_t to, Batch& batch, const Flush& flush) const {
    batch.x[batch.n] = at_[0][size_t(at[0])];
    batch.y[batch.n] = at_[1][size_t(at[1])];
    batch.z[batch.n] = at_[2][size_t(at[2])];
    batch.at[batch.n] = to;
    if (++batch.n == Batch::capacity) flush();
  }

  void count(size_t samples) { pulse_(double(done_ += samples) / double(grid_.size())); }

  Interval color_block(const Evaluator& above, const Block& block) {
    for_rows(grid_, block, [&](size_t first, size_t n) {
      std::fill_n(&samples_.colors[4 * first], 4 * n, 0.0f);
    });
    const std::vector<size_t> wanted = colored_in(grid_, samples_.field.get(), colored_, block);
    Interval range{infinity, -infinity};
    if (wanted.empty()) return range;
    std::optional<Evaluator> shorter;
    if (wanted.size() > few_samples) shorter = shortened(above, block, long_for_block);
    const Evaluator& program = shorter ? *shorter : above;
    Batch batch;
    const auto flush = [&] { color_batch(program, batch, range); };
    for (const size_t i : wanted) {
      const size_t row = i / size_t(grid_.counts[0]);
      add({int(i % size_t(grid_.counts[0])), int(row % size_t(grid_.counts[1])),
           int(row / size_t(grid_.counts[1]))},
          i, batch, flush);
    }
    if (batch.n > 0) flush();
    return range;
  }

  void color_batch(const Evaluator& program, Batch& batch, Interval& range) {
    float value[3][Batch::capacity];
    float* const out[3] = {value[0], value[1], value[2]};
    program.block(batch.x, batch.y, batch.z, batch.n, out);
    pulse_(double(done_) / double(grid_.size()));
    for (size_t i = 0; i < batch.n; ++i) {
      float* color = &samples_.colors[4 * batch.at[i]];
      bool is_finite = true;
      for (size_t c = 0; c < program.outputs(); ++c) {
        color[c] = value[c][i];
        is_finite = is_finite && std::isfinite(color[c]);
      }
      if (!is_finite) {
        std::fill_n(color, 4, 0.0f);
        continue;
      }
      color[3] = 1;
      range = {std::min(range.lo, double(color[0])), std::max(range.hi, double(color[0]))};
    }
    batch.n = 0;
  }

  const TexelGrid& grid_;
  Pulse pulse_;
  const Colored colored_;
  const Block all_;
  const Blocks blocks_, large_;
  std::array<std::vector<float>, 3> at_;
  float limit_;
  std::atomic<size_t> done_{0};
  VolumeSamples samples_;
};

void check(const VolumeSampling& sampling) {
  const TexelGrid& grid = sampling.grid;
  for (int axis = 0; axis < 3; ++axis) {
    const double from = grid.box.lo[axis], to = grid.box.hi[axis];
    if (!(from < to) || !std::isfinite(to - from)) {
      throw Error(std::string("the box reaches from ") + "xyz"[axis] + " = " + short_number(from) +
                  " to " + short_number(to) +
                  "; finite numbers, the smaller one first, are accepted");
    }
    if (grid.counts[axis] < 1 || grid.counts[axis] > most_along) {
      throw Error(std::string("there are ") + std::to_string(grid.counts[axis]) +
                  " samples along " + "xyz"[axis] + "; 1 to " + std::to_string(most_along) +
                  " are accepted");
    }
  }
  if (grid.size() > most_samples) {
    throw Error(std::to_string(grid.size()) + " samples are asked for; " +
                std::to_string(most_samples) + " together are accepted");
  }
  if (sampling.components.size() > 3) {
    throw Error("a colour has " + std::to_string(sampling.components.size()) +
                " components; 1 to 3 are accepted");
  }
}

}  // namespace

Colored colored_samples(const std::string& name) {
  if (name == "none") return Colored::nothing;
  if (name == "surface") return Colored::surface;
  if (name == "inside") return Colored::inside;
  throw Error("colors is '" + name + "'; accepted are 'none', 'surface' and 'inside'" +
              did_you_mean(name, {"none", "surface", "inside"}));
}

VolumeSamples sample_volume(const Scene& scene, const VolumeSampling& sampling,
                            const Progress& progress) {
  check(sampling);
  std::vector<Expression> color = sampling.components;
  if (color.empty()) {
    const std::array<Expression, 3> base = scene.base_color();
    color.assign(base.begin(), base.end());
  }
  Sampler sampler(sampling, progress);
  sampler.sample_field(Evaluator(sampling.sections ? scene.drawn() : scene.solid()));
  sampler.sample_colors(sampling.colored == Colored::nothing ? Evaluator(constant(0))
                                                             : Evaluator(color));
  return sampler.result();
}

}  // namespace sardf
