// A field as the user sees it: what is computed (an expression) and how it was made (a
// construction, from which scene files are written).
#pragma once

#include <array>
#include <map>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "sardf/blend.hpp"
#include "sardf/graph.hpp"

namespace sardf {

/// How a value relates to the true Euclidean distance: equal to it, never larger in magnitude, or
/// neither proven.
enum class Exactness : uint8_t { exact, bound, estimate };

struct Quality {
  Exactness inside = Exactness::estimate;
  Exactness outside = Exactness::estimate;
};

struct Construction;

class Field {
 public:
  Field() = default;
  Field(Expression value, Quality how_exact, std::shared_ptr<const Construction> how_made);

  /// A number as a field.
  static Field number(double value);
  /// The coordinate field x, y or z.
  static Field coordinate(int axis);

  const Expression& expression() const { return expression_; }
  Quality quality() const { return quality_; }
  /// Never null for a field made by a constructor or a formula.
  const Construction* construction() const { return construction_.get(); }
  explicit operator bool() const { return expression_ != nullptr; }

 private:
  Expression expression_;
  Quality quality_;
  std::shared_ptr<const Construction> construction_;
};

/// A plane field at a height.
struct PlaneSection {
  Field field;
  double z = 0;
};

/// A file that a scene names: as it was written, and the folder that it is relative to.
struct FilePath {
  std::string text, folder;
  /// Where the file is.
  std::string full() const;
  friend bool operator==(const FilePath&, const FilePath&) = default;
};

/// Rows of points: the control points of a surface.
using PointGrid = std::vector<std::vector<Vec3>>;

struct Rule;
/// A rule of fractions.hpp that gives one number.
using RulePointer = std::shared_ptr<const Rule>;

/// The value of one parameter. Axes are vectors here; monostate is an optional value not given.
using Value = std::variant<std::monostate, bool, double, std::string, Vec2, Vec3,
                           std::array<double, 4>, std::vector<Vec2>, std::vector<Vec3>, Field,
                           std::vector<Field>, std::vector<PlaneSection>, BlendPointer,
                           std::vector<double>, PointGrid, FilePath, RulePointer>;

struct Constructor;

/// A constructor with its arguments, or a formula with the fields it names.
struct Construction {
  const Constructor* constructor = nullptr;  // null: a formula
  std::vector<Value> arguments;              // in the order of the constructor's parameters
  std::string formula;
  std::map<std::string, Field> names;

  Construction() = default;
  Construction(const Construction&) = delete;
  Construction& operator=(const Construction&) = delete;
  /// Drops the fields it holds without recursion: chains may be 100 000 long.
  ~Construction();
};

/// A formula's field: the expression, and the text and names it came from (formula.hpp parses).
Field formula_field(Expression expression, std::string text, std::map<std::string, Field> names);

/// a + b and the like as fields; `symbol` is +, -, *, / or ^. Also serves Python's operators.
Field combine(const Field& a, char symbol, const Field& b);
Field negate(const Field& a);

}  // namespace sardf
