// All long work: the same bits for 1 and 2 threads, and a progress that throws or cancels in the
// middle is passed on and leaves everything in order.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cstring>

#include "laws.hpp"
#include "sardf/bake.hpp"
#include "sardf/bounds.hpp"
#include "sardf/certify.hpp"
#include "sardf/scene_file.hpp"
#include "sardf/surface.hpp"
#include "sardf/volume.hpp"

namespace sardf {
namespace {

const Scene& scene() {
  static const Scene made(parse_scene(R"json({"sardf": 1,
    "materials": {"a": {"color": "#ff0000"}, "b": {"color": "#0000ff"}},
    "solid": {"difference": {"of": [
      {"union": {"of": [{"box": {"size": [6, 5, 3]}}, {"sphere": {"radius": 2.6}}],
                 "blend": {"sardf": 0.5}}},
      {"cylinder": {"radius": 0.8, "height": 9}}]}},
    "fractions": {"functions": {"a": "=0.5 + 0.4 * sin(x)", "b": "rest"}}})json",
                                      ""));
  return made;
}

/// The bytes of results, one after the other.
class Bytes {
 public:
  template <class T, class Memory>
  void add(const std::vector<T, Memory>& data) {
    static_assert(std::is_trivially_copyable_v<T>);
    const char* first = reinterpret_cast<const char*>(data.data());
    all_.insert(all_.end(), first, first + data.size() * sizeof(T));
  }
  void add(double a) { add(std::vector<double>{a}); }
  bool operator==(const Bytes&) const = default;
  bool empty() const { return all_.empty(); }

 private:
  std::vector<char> all_;
};

Evaluator outputs() {
  std::vector<Expression> all{scene().solid()};
  all.insert(all.end(), scene().fractions().begin(), scene().fractions().end());
  return Evaluator(all);
}

std::vector<double> some_points(size_t n) {
  laws::Random r(91);
  std::vector<double> points(3 * n);
  for (double& a : points) a = r.uniform(-4, 4);
  return points;
}

struct LongWork {
  const char* name;
  Bytes (*run)(const Progress&);
};

Bytes evaluate(const Progress& progress) {
  constexpr size_t n = 50001;
  const Evaluator evaluator = outputs();
  const std::vector<double> points = some_points(n);
  const std::vector<float> single(points.begin(), points.end());
  std::vector<double> values(n * evaluator.outputs()), gradients(3 * n), fractions(2 * n);
  std::vector<float> floats(values.size());
  evaluator.values(points.data(), n, values.data(), progress);
  evaluator.values(single.data(), n, floats.data(), progress);
  evaluator.gradients(points.data(), n, nullptr, gradients.data());
  scene().fractions_at(points.data(), n, fractions.data());
  Bytes bytes;
  bytes.add(values);
  bytes.add(floats);
  bytes.add(gradients);
  bytes.add(fractions);
  return bytes;
}

Mesh surface(const Progress& progress) {
  SurfaceOptions options;
  options.resolution = 40;
  options.texture_size = 256;
  return make_surface(scene(), options, progress);
}

Bytes mesh(const Progress& progress) {
  const Mesh made = surface(progress);
  Bytes bytes;
  bytes.add(made.vertices);
  bytes.add(made.faces);
  bytes.add(made.corner_normals);
  bytes.add(made.corner_uv);
  bytes.add(made.creases);
  return bytes;
}

Bytes bake(const Progress& progress) {
  static const Mesh made = surface({});
  const TexelMap texels(made, 256, 8, progress);
  const std::vector<BakeChannel> channels{
      {"fractions_1", {scene().fractions()[0], scene().fractions()[1]}}};
  Bytes bytes;
  for (const Image& image : bake_images(texels, scene().solid(), channels, progress)) {
    bytes.add(image.samples);
  }
  return bytes;
}

Bytes volume(const Progress& progress) {
  const MaterialVolumes volumes = measure_volumes(scene(), 24, progress);
  Bytes bytes;
  bytes.add(volumes.materials);
  bytes.add(volumes.total);
  bytes.add(volumes.error);
  return bytes;
}

Bytes certify(const Progress& progress) {
  const Evaluator evaluator(scene().solid());
  const BoundingBox box = certified_bounds(evaluator, progress);
  Bytes bytes;
  for (const Vec3& corner : {box.lo, box.hi}) bytes.add(std::vector<Vec3>{corner});
  bytes.add(lipschitz_bound(evaluator, box, 64));
  bytes.add(error_bound(scene().solid()));
  return bytes;
}

constexpr LongWork all_long_work[] = {{"evaluate", evaluate},
                                      {"mesh", mesh},
                                      {"bake", bake},
                                      {"volume", volume},
                                      {"certify", certify}};

class LongWorkOf : public testing::TestWithParam<LongWork> {};

TEST_P(LongWorkOf, GivesTheSameBitsForOneAndTwoThreads) {
  const auto with = [](size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return GetParam().run({});
  };
  const Bytes one = with(1);
  EXPECT_FALSE(one.empty());
  for (int again = 0; again < 2; ++again) EXPECT_TRUE(with(2) == one);
}

struct Stop : std::runtime_error {
  Stop() : std::runtime_error("the user's own") {}
};

// After 0, 1, 2 and 5 reports, on one thread and on two.
TEST_P(LongWorkOf, PassesOnWhatItsProgressThrows) {
  const Bytes expected = GetParam().run({});
  int total = 0;
  GetParam().run([&](double) { return ++total, true; });
  ASSERT_GT(total, 0);
  for (const size_t threads : {1, 2}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    for (const int after : {0, 1, 2, 5}) {
      if (2 * after >= total) continue;
      int reports = 0;
      const Progress thrower = [&](double) -> bool {
        if (reports++ >= after) throw Stop();
        return true;
      };
      EXPECT_THROW(GetParam().run(thrower), Stop) << after << " of " << total;
      reports = 0;
      const Progress canceller = [&](double) { return reports++ < after; };
      EXPECT_THROW(GetParam().run(canceller), Cancelled) << after << " of " << total;
    }
    EXPECT_TRUE(GetParam().run({}) == expected);
  }
}

INSTANTIATE_TEST_SUITE_P(All, LongWorkOf, testing::ValuesIn(all_long_work),
                         [](const auto& named) { return std::string(named.param.name); });

}  // namespace
}  // namespace sardf
