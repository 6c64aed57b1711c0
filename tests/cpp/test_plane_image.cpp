// Pictures of fields on a plane, and fields from lists of steps.
#include "sardf/plane_image.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <functional>

#include "error_of.hpp"
#include "laws.hpp"
#include "sardf/arithmetic.hpp"
#include "sardf/vm_file.hpp"

namespace sardf {
namespace {

using testing::HasSubstr;

// Every pixel one by one in double.
std::vector<uint8_t> dense(const Evaluator& field, const PlaneView& view) {
  std::vector<uint8_t> pixels;
  for (int row = 0; row < view.height; ++row) {
    for (int column = 0; column < view.width; ++column) {
      pixels.push_back(field.value({view.x(column), view.y(row), view.z}) >= 0);
    }
  }
  return pixels;
}

// A page of strokes: turned boxes and rings, joined and cut, in the elementary steps of a .vm file.
std::string page_of_strokes(laws::Random& r, int strokes) {
  std::string text = "# strokes\nx var-x\ny var-y\nlast const 1\n";
  int next = 0;
  const auto add = [&](const std::string& step) {
    const std::string name = "_" + std::to_string(next++);
    text += name + " " + step + "\n";
    return name;
  };
  const auto number = [&](double a) { return add("const " + std::to_string(a)); };
  std::string all = add("abs last");
  for (int i = 0; i < strokes; ++i) {
    const std::string dx = add("sub x " + number(r.uniform(-1, 1)));
    const std::string dy = add("sub y " + number(r.uniform(-1, 1)));
    const double angle = r.uniform(0, 6.3);
    const auto turned = [&](double a, double b) {
      return add("add " + add("mul " + dx + " " + number(a)) + " " +
                 add("mul " + dy + " " + number(b)));
    };
    std::string shape;
    if (r.chance(0.5)) {
      const std::string a = turned(std::cos(angle), std::sin(angle));
      const std::string b = turned(-std::sin(angle), std::cos(angle));
      shape = add("max " + add("sub " + add("abs " + a) + " " + number(r.uniform(0.02, 0.3))) +
                  " " + add("sub " + add("abs " + b) + " " + number(r.uniform(0.005, 0.03))));
    } else {
      const std::string root =
          add("sqrt " + add("add " + add("square " + dx) + " " + add("square " + dy)));
      const std::string ring = add("sub " + root + " " + number(r.uniform(0.02, 0.1)));
      shape = add("sub " + add("abs " + ring) + " " + number(r.uniform(0.002, 0.02)));
    }
    all = r.chance(0.8) ? add("min " + all + " " + shape)
                        : add("max " + all + " " + add("neg " + shape));
  }
  return text;
}

TEST(PlaneImageSlow, IsTheDenseOne) {
  laws::Random r(71);
  for (const int strokes : {1, 10, 300}) {
    const Evaluator field(parse_vm(page_of_strokes(r, strokes)));
    for (const auto& [width, height] : {std::pair(200, 150), std::pair(17, 300), std::pair(1, 1)}) {
      PlaneView view;
      view.width = width;
      view.height = height;
      view.lo = {-1.1, -0.9};
      EXPECT_EQ(sign_image(field, view), dense(field, view)) << strokes << " strokes";
    }
  }
}

TEST(PlaneImageSlow, IsTheDenseOneForAnyField) {
  laws::Random r(72);
  for (int i = 0; i < laws::effort(200); ++i) {
    const Evaluator field(laws::random_field(r, 2).expression());
    PlaneView view{{-5, -4}, {4, 5}, r.uniform(-1, 1), 64, 48};
    EXPECT_EQ(sign_image(field, view), dense(field, view)) << i << ", seed " << laws::seed();
  }
}

TEST(PlaneImage, DoesNotDependOnThreads) {
  laws::Random r(73);
  const Evaluator field(parse_vm(page_of_strokes(r, 100)));
  PlaneView view;
  const std::vector<uint8_t> several = sign_image(field, view);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(sign_image(field, view), several);
}

TEST(PlaneImage, HasTheTopOfThePlaneInTheFirstRow) {
  const PlaneView view{{0, 0}, {4, 2}, 0, 4, 2};
  const Evaluator field(min(coordinate(1) - constant(1), constant(2) - coordinate(0)));
  EXPECT_EQ(sign_image(field, view), (std::vector<uint8_t>{1, 1, 0, 0, 0, 0, 0, 0}));
}

TEST(PlaneImage, CountsNoNumbersAsOutside) {
  const PlaneView view{{-1, -1}, {1, 1}, 0, 32, 32};
  const Evaluator field(log(coordinate(0)) + constant(9));
  EXPECT_EQ(sign_image(field, view), dense(field, view));
}

TEST(PlaneImage, RefusesBadViewsAndCancels) {
  const Evaluator field(coordinate(0));
  const auto message = [&](const PlaneView& view) {
    return error_of([&] { sign_image(field, view); });
  };
  EXPECT_THAT(message({{1, 0}, {0, 1}, 0, 8, 8}), HasSubstr("reaches from x = 1 to 0"));
  EXPECT_THAT(message({{0, 0}, {1, infinity}, 0, 8, 8}), HasSubstr("from y = 0"));
  EXPECT_THAT(message({{0, 0}, {1, 1}, 0, 0, 8}), HasSubstr("0 pixels wide or high; 1 to 65536"));
  EXPECT_THROW(sign_image(field, {}, [](double) { return false; }), Cancelled);
}

TEST(VmFile, KnowsEveryOperation) {
  const auto value = [](const std::string& steps, const Vec3& at) {
    // Negative inside there, positive here.
    return -Evaluator(parse_vm("x var-x\ny var-y\nz var-z\n" + steps)).value(at);
  };
  const double a = 0.7, b = -1.3;
  const Vec3 at{a, b, 0.25};
  EXPECT_EQ(value("r add x y", at), a + b);
  EXPECT_EQ(value("r sub x y", at), a - b);
  EXPECT_EQ(value("r mul x y", at), a * b);
  EXPECT_EQ(value("r div x y", at), a / b);
  EXPECT_EQ(value("r min x y", at), b);
  EXPECT_EQ(value("r max x y", at), a);
  EXPECT_DOUBLE_EQ(value("r mod y x", at), b - a * std::floor(b / a));
  EXPECT_EQ(value("r atan2 x y", at), std::atan2(a, b));
  EXPECT_EQ(value("r neg x", at), -a);
  EXPECT_EQ(value("r abs y", at), -b);
  EXPECT_EQ(value("r square y", at), b * b);
  EXPECT_EQ(value("r recip y", at), 1 / b);
  EXPECT_EQ(value("r floor y", at), -2);
  EXPECT_EQ(value("r ceil y", at), -1);
  EXPECT_EQ(value("r atan y", at), std::atan(b));
  const std::pair<const char*, double (*)(double)> functions[] = {{"sqrt", [](double t) { return std::sqrt(t); }},
                                                                  {"exp", [](double t) { return std::exp(t); }},
                                                                  {"ln", [](double t) { return std::log(t); }},
                                                                  {"sin", [](double t) { return std::sin(t); }},
                                                                  {"cos", [](double t) { return std::cos(t); }},
                                                                  {"tan", [](double t) { return std::tan(t); }},
                                                                  {"asin", [](double t) { return std::asin(t); }},
                                                                  {"acos", [](double t) { return std::acos(t); }}};
  for (const auto& [name, f] : functions) {
    EXPECT_DOUBLE_EQ(value(std::string("r ") + name + " x", at), f(a)) << name;
  }
  EXPECT_EQ(value("# a comment\n\n  c const 2.5e-1 # and one\nr max z c", at), 0.25);
}

TEST(VmFile, SaysWhereItIsWrong) {
  const auto message = [](const std::string& text) {
    return error_of([&] { parse_vm(text, "a.vm"); });
  };
  EXPECT_EQ(message("# nothing\n"), "a.vm: there is no expression");
  EXPECT_EQ(message("x var-x\nx\n"),
            "a.vm:2: found 'x' alone; a name and an operation are accepted");
  EXPECT_EQ(message("x var-x\nx var-y\n"), "a.vm:2: 'x' is given twice");
  EXPECT_EQ(message("a const\n"), "a.vm:1: const has 0 operands; one number is accepted");
  EXPECT_EQ(message("a const 1,5\n"), "a.vm:1: found '1,5'; a finite number is accepted");
  EXPECT_EQ(message("a const inf\n"), "a.vm:1: found 'inf'; a finite number is accepted");
  EXPECT_EQ(message("x var-x\n\nr neg x x\n"), "a.vm:3: neg has 2 operands; 1 is accepted");
  EXPECT_EQ(message("x var-x\nr max x\n"), "a.vm:2: max has 1 operands; 2 are accepted");
  EXPECT_EQ(message("r neg x\n"), "a.vm:1: 'x' is not given before this line");
  EXPECT_THAT(message("x var-x\nr sqr x\n"), HasSubstr("a.vm:2: there is no operation 'sqr'"));
  EXPECT_THAT(message("x var-x\nr sqr x\n"), HasSubstr("did you mean 'sqrt'?"));
  EXPECT_THAT(error_of([] { read_vm("no/such.vm"); }), HasSubstr("no/such.vm: cannot be read"));
}

// Long chains need no stack: there is no recursion.
TEST(VmFile, MayBeDeep) {
  std::string text = "_0 var-x\n";
  for (int i = 1; i <= 100000; ++i) {
    text += "_" + std::to_string(i) + " sin _" + std::to_string(i - 1) + "\n";
  }
  double expected = 0.5;
  for (int i = 0; i < 100000; ++i) expected = std::sin(expected);
  EXPECT_EQ(Evaluator(parse_vm(text)).value({0.5, 0, 0}), -expected);
}

}  // namespace
}  // namespace sardf
