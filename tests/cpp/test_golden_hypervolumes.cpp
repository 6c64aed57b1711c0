// The objects of the SARDF paper's section 6 against golden values: fields, gradients and the
// fractions between two materials, for three blends.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "golden.hpp"
#include "sardf/constructor.hpp"
#include "sardf/scene.hpp"

namespace sardf {
namespace {

using golden::Table;

/// The fields of a figure by the names of its columns: G is the object, M1 and M2 are the parts of
/// one material alone.
struct Object {
  std::map<std::string, Field> fields;
  Field solid;  // G, in space
};

/// Makes fields from a file's parameters.
class Maker {
 public:
  Maker(const Table& table, const BlendPointer& blend) : table_(table), blend_(blend) {}

  Field join(const char* how, std::vector<Field> fields) const {
    return make_field(how, {std::move(fields), blend_});
  }
  Field disc(const char* center, const char* radius) const {
    return make_field("disc", {table_.parameter(center).get<Vec2>(), number(radius)});
  }
  Field rectangle(const char* center, const char* half) const {
    const Vec2 h = table_.parameter(half);
    return make_field("box2d", {table_.parameter(center).get<Vec2>(), Vec2{2 * h[0], 2 * h[1]}});
  }
  Field contour(const char* name) const {
    return make_field("implicit_polygon",
                      {table_.parameter(name).get<std::vector<Vec2>>(), blend_});
  }
  Field block(const Vec3& center, const char* half) const {
    return make_field("box", {center, 2.0 * vector(half)});
  }
  Field egg(const Vec3& center, const char* radii) const {
    return make_field("ellipsoid", {center, vector(radii)});
  }
  double number(const char* name) const { return table_.parameter(name); }
  Vec3 vector(const char* name) const { return table_.parameter(name); }

 private:
  const Table& table_;
  BlendPointer blend_;
};

Field plate_of(const Field& plane) { return make_field("extrude", {plane, 2.0}); }

// Section 6.1: a plate with a hole.
Object cad_2d(const Maker& make) {
  const Field box = make.rectangle("box_c", "box_half"), hole = make.disc("hole_centre", "r_hole");
  const Field inner = make.disc("hole_centre", "r_SP1"), outer = make.disc("hole_centre", "r_SP2");
  const Field whole = make.join("difference", {box, hole});
  const Field first = make.join("difference", {whole, inner});
  const Field second = make.join("intersection", {whole, outer});
  return {{{"G", whole},
           {"SP1", first},
           {"SP2", second},
           {"M1", make.join("difference", {whole, outer})},
           {"M2", make.join("difference", {make.join("intersection", {box, inner}), hole})},
           {"blend", make.join("intersection", {first, second})}},
          plate_of(whole)};
}

// Section 6.2: a block with four grooved pins on a plate inside.
Object cad_3d(const Maker& make) {
  const Vec3 plate_at{0, make.number("plate_y"), 0};
  const double spacing = make.number("pin_spacing"), off = make.number("groove_offset");
  const Field whole = make.block({}, "G_half");
  std::vector<Field> pins{make.block(plate_at, "plate_half")};
  std::vector<Field> wide{make.block(plate_at, "plate2_half")};
  for (const auto& [sx, sz] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
    const Vec3 c{sx * spacing, make.number("pin_y"), sz * spacing};
    std::vector<Field> grooves;
    for (const auto& [ax, az] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
      grooves.push_back(make.egg(c + off * Vec3{double(ax), 0, double(az)}, "groove_radii"));
    }
    pins.push_back(
        make.join("difference", {make.egg(c, "pin_radii"), make.join("union", grooves)}));
    wide.push_back(make.egg(c, "pin_SP2_radii"));
  }
  const Field pure = make.join("intersection", {make.join("union", pins), whole});
  const Field second = make.join("intersection", {make.join("union", wide), whole});
  return {{{"G", whole},
           {"pin0", pins[1]},
           {"M2", pure},
           {"SP2", second},
           {"SP1", make.join("difference", {whole, pure})},
           {"M1", make.join("difference", {whole, second})}},
          whole};
}

// Section 6.3: a tooth with an inlay.
Object tooth(const Maker& make) {
  const Field outer = make.contour("outer"), inlay = make.contour("inlay");
  const Field middle = make.contour("middle");
  return {{{"G", outer},
           {"SP1", make.join("difference", {outer, inlay})},
           {"SP2", middle},
           {"M1", make.join("difference", {outer, middle})},
           {"M2", inlay},
           {"blend", make.join("difference", {middle, inlay})},
           {"dentin", make.contour("dentin")}},
          plate_of(outer)};
}

struct Figure {
  const char* file;
  Object (*make)(const Maker&);
};

/// A blend by the name that it has in the columns.
BlendPointer blend_of(const std::string& tag, const Table& table) {
  if (tag == "sardf") return make_blend("sardf", {table.parameter("R").get<double>()});
  return make_blend(tag == "rfun" ? "r_function" : "min_max", {});
}

class GoldenHypervolume : public golden::EachFolderWith<Figure> {
 protected:
  GoldenHypervolume() : table_(read(this_case().file)) {
    const int z = table_.find("z");
    for (const std::vector<double>& row : table_.rows) {
      points_.insert(points_.end(), {row[0], row[1], z < 0 ? 0.0 : row[size_t(z)]});
    }
    float_points_.assign(points_.begin(), points_.end());
  }

  Object object(const std::string& blend) const {
    return this_case().make(Maker(table_, blend_of(blend, table_)));
  }
  Scene scene(const Object& object) const {
    SceneDescription description;
    description.solid = object.solid;
    description.materials.resize(2);
    description.materials[0].name = "a";
    description.materials[1].name = "b";
    const auto side = [&](const char* field, const char* material) {
      return Record{{object.fields.at(field), Fractions::material(material)}};
    };
    description.fractions =
        make_fractions("blend_between", {std::vector<Record>{side("M1", "a"), side("M2", "b")}});
    return Scene(description);
  }
  size_t size() const { return table_.rows.size(); }
  double expected(size_t row, const std::string& column) const {
    return table_.rows[row][table_.column(column)];
  }

  Table table_;
  std::vector<double> points_;
  std::vector<float> float_points_;
};

// Values reach the size of the object; float has them to a few units of the last place.
constexpr double float_tolerance = 2e-5;

TEST_P(GoldenHypervolume, Fields) {
  const Object made = object("sardf");
  std::vector<double> out(size());
  std::vector<float> rough(size());
  std::vector<std::string> columns;
  for (const auto& [name, field] : made.fields) {
    const Evaluator evaluator(field.expression());
    evaluator.values(points_.data(), size(), out.data());
    evaluator.values(float_points_.data(), size(), rough.data());
    columns.push_back("f_" + name);
    for (size_t i = 0; i < size(); ++i) {
      EXPECT_NEAR(out[i], expected(i, columns.back()), table_.tolerance()) << name << " row " << i;
      EXPECT_NEAR(rough[i], expected(i, columns.back()), float_tolerance) << name << " row " << i;
    }
  }
  // No column is left out.
  for (const std::string& column : table_.names) {
    if (column.starts_with("f_")) {
      EXPECT_THAT(columns, testing::Contains(column));
    }
  }
}

TEST_P(GoldenHypervolume, Gradients) {
  const Object made = object("sardf");
  std::vector<double> out(size()), gradient(3 * size());
  for (const std::string name : {"G", "M1"}) {
    Evaluator(made.fields.at(name).expression())
        .gradients(points_.data(), size(), out.data(), gradient.data());
    size_t compared = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const int column = table_.find(name + "_g" + char('x' + axis));
      if (column < 0) continue;
      for (size_t i = 0; i < size(); ++i) {
        const double value = table_.rows[i][size_t(column)];
        if (std::isnan(value)) continue;
        ++compared;
        EXPECT_NEAR(gradient[3 * i + axis], value, table_.tolerance())
            << name << " row " << i << " axis " << axis;
      }
    }
    EXPECT_GT(compared, size());
  }
}

TEST_P(GoldenHypervolume, DistancesAndFractions) {
  for (const std::string tag : {"sardf", "rfun", "minmax"}) {
    SCOPED_TRACE(tag);
    const Object made = object(tag);
    const Scene whole = scene(made);
    const std::vector<Expression> distances{feature_distance(made.fields.at("M1")),
                                            feature_distance(made.fields.at("M2"))};
    std::vector<double> d(2 * size()), shares(2 * size());
    std::vector<float> rough(2 * size());
    Evaluator(distances).values(points_.data(), size(), d.data());
    whole.fractions_at(points_.data(), size(), shares.data(), true);
    Evaluator(whole.fractions()).values(float_points_.data(), size(), rough.data());
    size_t inside = 0, in_float = 0;
    for (size_t i = 0; i < size(); ++i) {
      const double sum = expected(i, "d1_" + tag) + expected(i, "d2_" + tag);
      for (size_t k = 0; k < 2; ++k) {
        const std::string place = std::to_string(k + 1);
        const double value = expected(i, "m" + place + "_" + tag), share = shares[2 * i + k];
        EXPECT_EQ(std::isnan(value), std::isnan(share)) << "row " << i;
        if (std::isnan(value)) continue;
        ++inside;
        EXPECT_NEAR(d[2 * i + k], expected(i, "d" + place + "_" + tag), table_.tolerance())
            << "row " << i;
        EXPECT_NEAR(share, value, table_.tolerance()) << "row " << i;
        // Where both distances are rounding errors, so is their ratio.
        if (!(sum > 1e-2)) continue;
        ++in_float;
        EXPECT_NEAR(rough[2 * i + k], value, float_tolerance / sum) << "row " << i;
      }
    }
    // Some points are outside.
    EXPECT_LT(inside, 2 * size());
    EXPECT_GT(inside, size() / 4);
    EXPECT_GT(in_float, size() / 4);
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, GoldenHypervolume,
    testing::Combine(golden::each_folder(),
                     testing::Values(Figure{"fig_sardf_61_cad2d", cad_2d},
                                     Figure{"fig_sardf_61_section", cad_2d},
                                     Figure{"fig_sardf_62_cad3d", cad_3d},
                                     Figure{"fig_sardf_63_tooth", tooth},
                                     Figure{"fig_sardf_63_section_y2", tooth})),
    [](const auto& of) {
      return golden::test_name(std::get<0>(of.param)) + "_" + std::get<1>(of.param).file;
    });

using GoldenContours = golden::InEachFolder;

// With the papers' parameters the contours are those of the figures; every other draw has its own
// for each file.
TEST_P(GoldenContours, AreThoseOfTheTooth) {
  for (const std::string name : {"outer", "dentin", "inlay", "middle"}) {
    const Table table = read("poly_tooth_" + name);
    std::vector<Vec2> corners;
    for (const std::vector<double>& row : table.rows) corners.push_back({row[0], row[1]});
    EXPECT_EQ(corners, table.parameter("v").get<std::vector<Vec2>>()) << name;
    if (table.header.at("vary").get<bool>()) continue;
    for (const char* figure : {"fig_sardf_63_tooth", "fig_sardf_63_section_y2"}) {
      EXPECT_EQ(corners, read(figure).parameter(name.c_str()).get<std::vector<Vec2>>()) << name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Each, GoldenContours, golden::each_folder(), golden::folder_name);

}  // namespace
}  // namespace sardf
