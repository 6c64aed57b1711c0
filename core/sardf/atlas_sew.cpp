// The atlas's fifth stage: sews neighbouring charts together. A plan made with rigid charts picks
// what to join; each joined chart is then relaxed and checked, and taken apart again when it
// stretches too much or comes too close to itself.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "sardf/atlas_seams.hpp"
#include "sardf/atlas_stages.hpp"

namespace sardf::atlas {
namespace {

constexpr int sew_iterations = 4;

struct Level {
  double stretch;   // largest that a sewn chart may have
  double mismatch;  // of rigid sides, as a share of the smaller chart's width
  double share;     // of the shorter boundary that must be sewn
  bool always;      // also when there are few charts
  bool thin_gap;
};
// The first level makes charts that are better than their parts; the others trade stretch and
// compactness for fewer charts.
constexpr Level levels[] = {{1.15, 0.10, 0.22, true, false}, {1.40, 0.25, 0.22, false, true},
                            {1.70, 0.40, 0.22, false, true}, {2.00, 0.60, 0.16, false, true},
                            {2.00, 0.60, 0.10, false, true}, {2.00, 0.60, 0.05, false, true},
                            {2.20, 0.60, 0.00, false, true}};

/// Crumbs, left over where a mesh is uneven along creases, hardly take up texels themselves, but
/// their gutters do, and bilinear lookups like no borders: they are sewn on at any stretch.
constexpr double crumb_stretch = 30;
bool is_crumb(double area, double gap) { return area < 4 * gap * gap; }

using Pair = std::pair<uint32_t, uint32_t>;

struct Cluster {
  std::vector<uint32_t> charts;
  std::vector<Pair> joins;
  std::vector<uint32_t> sewn;
};

class Tailor {
 public:
  Tailor(const Surface& surface, Layout& layout, const Report& report)
      : surface_(surface), layout_(layout), report_(report) {}

  /// Joins what it can once; returns the number of charts that vanished.
  size_t round(const Level& level, double gap);
  void forget_failures() {
    failed_.clear();
    alone_.clear();
  }

 private:
  struct Candidate {
    double score;
    Pair pair;
  };
  void gather(double gap);
  std::vector<Candidate> candidates(const Level& level) const;
  Vec2 placed(uint32_t corner) const {
    return motion_[layout_.chart_of_face[corner / 4]](layout_.flat[corner]);
  }
  Motion fit_sides(const std::vector<uint32_t>& run) const;
  double mismatch(const std::vector<uint32_t>& run, const Motion& motion) const;
  bool plan(const Pair& pair, const Level& level, double gap);
  void absorb(uint32_t a, uint32_t b, const Motion& motion);
  bool apart(const Cluster& a, const Cluster& b, const Motion& motion,
             const std::vector<uint32_t>& sewn, double gap) const;
  bool join(const Cluster& cluster, const Level& level, double gap, std::vector<uint32_t>& faces);

  const Surface& surface_;
  Layout& layout_;
  const Report& report_;
  std::map<Pair, std::vector<uint32_t>> shared_;  // half-edges on the first chart's side
  std::vector<double> area_, perimeter_;
  std::vector<std::vector<BoundarySample>> samples_;
  size_t sampled_ = 0;
  double sampled_gap_ = 0;
  std::vector<Motion> motion_;
  std::vector<uint32_t> cluster_of_;
  std::vector<Cluster> clusters_;
  std::set<Pair> failed_, alone_;
};

void Tailor::gather(double gap) {
  const size_t count = layout_.faces.size();
  shared_.clear();
  area_.assign(count, 0);
  perimeter_.assign(count, 0);
  samples_.resize(count);
  motion_.assign(count, Motion{});
  cluster_of_.resize(count);
  clusters_.assign(count, Cluster{});
  for (uint32_t c = 0; c < count; ++c) {
    cluster_of_[c] = c;
    clusters_[c].charts = {c};
  }
  for (uint32_t h = 0; h < 4 * surface_.face_count(); ++h) {
    const uint32_t a = layout_.chart_of_face[h / 4], twin = surface_.twin[h];
    area_[a] += surface_.area[h / 4] / 4;
    if (layout_.sewn[h]) continue;
    perimeter_[a] += norm(surface_.point(surface_.next(h)) - surface_.point(h));
    if (twin == none) continue;
    const uint32_t b = layout_.chart_of_face[twin / 4];
    if (a < b) shared_[{a, b}].push_back(h);
  }
  // Charts never change, they only give way to new ones: older samples are still right.
  const size_t known = sampled_gap_ == gap ? sampled_ : 0;
  tbb::parallel_for(known, count, [&](size_t c) {
    samples_[c] = sample_boundary(surface_, layout_,
                                  boundary_loops(surface_, layout_, layout_.faces[c]), gap);
  });
  sampled_ = count;
  sampled_gap_ = gap;
}

std::vector<Tailor::Candidate> Tailor::candidates(const Level& level) const {
  std::vector<Candidate> result;
  for (const auto& [pair, half_edges] : shared_) {
    if (failed_.contains(pair)) continue;
    double length = 0;
    for (const uint32_t h : half_edges)
      length += norm(surface_.point(surface_.next(h)) - surface_.point(h));
    const double share = length / std::min(perimeter_[pair.first], perimeter_[pair.second]);
    if (share < level.share) continue;
    // With few charts the best seam counts; otherwise small charts go first.
    const double size = std::sqrt(area_[pair.first] + area_[pair.second]);
    result.push_back({level.always ? share : share / size, pair});
  }
  std::sort(result.begin(), result.end(), [](const Candidate& p, const Candidate& q) {
    return p.score != q.score ? p.score > q.score : p.pair < q.pair;
  });
  return result;
}

/// The motion that brings the far sides of the half-edges closest to their near sides.
Motion Tailor::fit_sides(const std::vector<uint32_t>& run) const {
  std::vector<PointPair> pairs;
  for (const uint32_t h : run) {
    const uint32_t after_h = surface_.next(h), twin = surface_.twin[h];
    const double weight = norm(surface_.point(after_h) - surface_.point(h)) + 1e-300;
    pairs.push_back({placed(surface_.next(twin)), placed(h), weight});
    pairs.push_back({placed(twin), placed(after_h), weight});
  }
  return fit(pairs);
}

double Tailor::mismatch(const std::vector<uint32_t>& run, const Motion& motion) const {
  double worst = 0;
  for (const uint32_t h : run) {
    const Vec2 p = placed(h), q = motion(placed(surface_.next(surface_.twin[h])));
    worst = std::max(worst, std::hypot(p[0] - q[0], p[1] - q[1]));
  }
  return worst;
}

/// Whether no boundary of b, moved, faces one of a closer than `gap`, except near sewn sides.
bool Tailor::apart(const Cluster& a, const Cluster& b, const Motion& motion,
                   const std::vector<uint32_t>& sewn, double gap) const {
  std::vector<BoundarySample> samples;
  const auto add = [&](const Cluster& cluster, const Motion& extra, uint32_t side) {
    for (const uint32_t c : cluster.charts) {
      const Motion whole = after(extra, motion_[c]);
      for (const BoundarySample& s : samples_[c])
        samples.push_back({whole(s.position), whole.turn(s.outward), side, 0, 1e300});
    }
  };
  add(a, Motion{}, 0);
  add(b, motion, 1);
  std::vector<Vec2> seam;
  for (const uint32_t h : sewn) seam.push_back(placed(h));
  return !too_close(without_near(samples, seam, 4 * gap), gap);
}

bool Tailor::plan(const Pair& pair, const Level& level, double gap) {
  const uint32_t a = cluster_of_[pair.first], b = cluster_of_[pair.second];
  const auto paths = runs_of(surface_, shared_.at(pair));
  const Motion motion = fit_sides(paths[0]);
  const double area = std::min(area_[pair.first], area_[pair.second]);
  const bool crumb = is_crumb(area, gap);
  const double tolerance = level.mismatch * std::sqrt(area);
  if (!crumb && mismatch(paths[0], motion) > tolerance) return false;
  std::vector<uint32_t> sewn = paths[0];
  for (const uint32_t p : clusters_[a].charts)
    for (const uint32_t q : clusters_[b].charts) {
      const auto found = shared_.find({std::min(p, q), std::max(p, q)});
      if (found == shared_.end()) continue;
      std::vector<uint32_t> near_side = found->second;
      if (p > q)
        for (uint32_t& h : near_side) h = surface_.twin[h];
      for (const auto& run : runs_of(surface_, near_side))
        if (run[0] != paths[0][0] && mismatch(run, motion) <= tolerance)
          sewn.insert(sewn.end(), run.begin(), run.end());
    }
  if (!crumb && !apart(clusters_[a], clusters_[b], motion, sewn, gap)) return false;
  clusters_[a].joins.push_back(pair);
  clusters_[a].sewn.insert(clusters_[a].sewn.end(), sewn.begin(), sewn.end());
  absorb(a, b, motion);
  return true;
}

void Tailor::absorb(uint32_t a, uint32_t b, const Motion& motion) {
  for (const uint32_t c : clusters_[b].charts) {
    motion_[c] = after(motion, motion_[c]);
    cluster_of_[c] = a;
  }
  const auto append = [](auto& to, const auto& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  append(clusters_[a].charts, clusters_[b].charts);
  append(clusters_[a].joins, clusters_[b].joins);
  append(clusters_[a].sewn, clusters_[b].sewn);
  clusters_[b] = Cluster{};
}

/// Sews and relaxes a cluster; leaves the layout as it was when the result is not good enough.
bool Tailor::join(const Cluster& cluster, const Level& level, double gap,
                  std::vector<uint32_t>& faces) {
  report_();
  for (const uint32_t c : cluster.charts)
    faces.insert(faces.end(), layout_.faces[c].begin(), layout_.faces[c].end());
  std::sort(faces.begin(), faces.end());
  std::vector<Vec2> before;
  for (const uint32_t f : faces)
    for (uint32_t c = 4 * f; c < 4 * f + 4; ++c) {
      before.push_back(layout_.flat[c]);
      layout_.flat[c] = placed(c);
    }
  for (const uint32_t h : cluster.sewn) layout_.sewn[h] = layout_.sewn[surface_.twin[h]] = 1;
  ChartMesh chart = build_chart(surface_, layout_, faces);
  Quality quality = measure(chart);
  if (quality.folded > 0 || quality.stretch_high > 1.005) {
    relax(chart, sew_iterations, report_);
    quality = measure(chart);
  }
  double smallest = area_[cluster.charts[0]];
  for (const uint32_t c : cluster.charts) smallest = std::min(smallest, area_[c]);
  const double limit = is_crumb(smallest, gap) ? crumb_stretch : level.stretch;
  if (quality.stretch_high <= limit &&
      store_embedded(surface_, faces, gap, chart, layout_, report_))
    return true;
  for (const uint32_t h : cluster.sewn) layout_.sewn[h] = layout_.sewn[surface_.twin[h]] = 0;
  for (size_t i = 0; i < before.size(); ++i) layout_.flat[4 * faces[i / 4] + i % 4] = before[i];
  return false;
}

size_t Tailor::round(const Level& level, double gap) {
  constexpr size_t most_charts = 3;
  gather(gap);
  for (const Candidate& candidate : candidates(level)) {
    const Pair& pair = candidate.pair;
    const uint32_t a = cluster_of_[pair.first], b = cluster_of_[pair.second];
    if (a == b) continue;
    const size_t size = clusters_[a].charts.size() + clusters_[b].charts.size();
    if (size > (alone_.contains(pair) ? 2 : most_charts)) continue;
    report_();
    if (!plan(pair, level, gap) && size == 2) failed_.insert(pair);
  }
  std::vector<Cluster> work;
  for (Cluster& cluster : clusters_)
    if (cluster.charts.size() > 1) work.push_back(std::move(cluster));
  std::vector<std::vector<uint32_t>> faces(work.size());
  std::vector<char> joined(work.size(), 0);
  tbb::parallel_for(size_t{0}, work.size(),
                    [&](size_t i) { joined[i] = join(work[i], level, gap, faces[i]); });
  size_t vanished = 0;
  for (size_t i = 0; i < work.size(); ++i) {
    if (!joined[i]) {
      auto& memory = work[i].charts.size() == 2 ? failed_ : alone_;
      memory.insert(work[i].joins.begin(), work[i].joins.end());
      continue;
    }
    for (const uint32_t c : work[i].charts) layout_.faces[c].clear();
    for (const uint32_t f : faces[i])
      layout_.chart_of_face[f] = static_cast<uint32_t>(layout_.faces.size());
    layout_.faces.push_back(std::move(faces[i]));
    vanished += work[i].charts.size() - 1;
  }
  return vanished;
}

size_t count_charts(const Layout& layout) {
  return static_cast<size_t>(std::count_if(layout.faces.begin(), layout.faces.end(),
                                           [](const auto& faces) { return !faces.empty(); }));
}

}  // namespace

void sew_charts(const Surface& surface, Layout& layout, double gap, double thin_gap, size_t target,
                const Report& report) {
  Tailor tailor(surface, layout, report);
  for (const Level& level : levels) {
    if (!level.always && count_charts(layout) <= target) break;
    const double wanted = level.thin_gap ? thin_gap : gap;
    tailor.forget_failures();
    for (int i = 0; i < 12; ++i) {
      const size_t vanished = tailor.round(level, wanted);
      if (!level.always && count_charts(layout) <= target) break;
      if (vanished == 0 && i > 1) break;
    }
  }
}

}  // namespace sardf::atlas
