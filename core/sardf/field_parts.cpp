#include "sardf/field_parts.hpp"

#include <set>

#include "sardf/constructor.hpp"
#include "sardf/shapes_combine.hpp"
#include "sardf/shapes_contour.hpp"
#include "sardf/shapes_normalize.hpp"

namespace sardf {

namespace {

void append_fields(const std::vector<RuleValue>& values, std::vector<Field>& to) {
  for (const RuleValue& value : values) {
    if (const auto* field = std::get_if<Field>(&value)) to.push_back(*field);
    if (const auto* all = std::get_if<std::vector<Field>>(&value)) {
      to.insert(to.end(), all->begin(), all->end());
    }
    if (const auto* functions = std::get_if<MaterialFunctions>(&value)) {
      for (const auto& [name, field] : *functions) {
        if (field) to.push_back(field);
      }
    }
    if (const auto* nested = std::get_if<Fractions>(&value)) sardf::append_fields(*nested, to);
    if (const auto* records = std::get_if<std::vector<Record>>(&value)) {
      for (const Record& record : *records) append_fields(record.values, to);
    }
  }
}

}  // namespace

void append_fields(const Value& value, std::vector<Field>& to) {
  if (const auto* field = std::get_if<Field>(&value)) to.push_back(*field);
  if (const auto* fields = std::get_if<std::vector<Field>>(&value)) {
    to.insert(to.end(), fields->begin(), fields->end());
  }
  if (const auto* sections = std::get_if<std::vector<PlaneSection>>(&value)) {
    for (const PlaneSection& section : *sections) to.push_back(section.field);
  }
  if (const auto* rule = std::get_if<RulePointer>(&value)) append_fields(Fractions(*rule), to);
}

void append_fields(const Fractions& fractions, std::vector<Field>& to) {
  if (fractions) append_fields(fractions.rule().arguments, to);
}

namespace {

bool makes_no_distance(const Constructor& constructor) {
  return constructor.group == "function" || constructor.name == Loft::name ||
         constructor.name == BlendError::name;
}

}  // namespace

bool is_distance(const Field& field) {
  std::vector<Field> open{field};
  std::set<const Construction*> seen;
  while (!open.empty()) {
    const Field part = open.back();
    open.pop_back();
    const Construction* made = part.construction();
    if (!made || !made->constructor || makes_no_distance(*made->constructor)) return false;
    if (!seen.insert(made).second || made->constructor->name == Normalized::name) continue;
    // The first argument that holds fields is what is joined, changed or moved; others, such as
    // what cuts a boundary down, decide only where.
    const size_t before = open.size();
    for (const Value& value : made->arguments) {
      append_fields(value, open);
      if (open.size() > before) break;
    }
    if (open.size() > before || made->constructor->group == "feature") continue;
    const Quality quality = part.quality();
    if (quality.inside == Exactness::estimate && quality.outside == Exactness::estimate) {
      return false;
    }
  }
  return true;
}

}  // namespace sardf
