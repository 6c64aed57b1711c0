#include "cli/compare_json.hpp"

#include <nlohmann/json.hpp>

namespace sardf {

namespace {

nlohmann::ordered_json to_json(const ColorAgreement& color) {
  return {{"compared_pixels", color.compared_pixels},
          {"median", color.median},
          {"quantile_99", color.quantile_99},
          {"maximum", color.maximum},
          {"left_out_share", color.left_out_share},
          {"outline_share", color.outline_share},
          {"left_out_within_share", color.left_out_within_share}};
}

}  // namespace

nlohmann::ordered_json to_json(const Comparison& comparison, const Limits& limits) {
  nlohmann::ordered_json json = {
      {"passes", passes(comparison, limits)},
      {"width", comparison.width},
      {"height", comparison.height},
      {"intersection_over_union", comparison.intersection_over_union},
      {"edge_elements", comparison.edge_elements},
      {"edge_within_half_pixel_share", comparison.edge_within_half_pixel_share},
      {"edge_distance_99", comparison.edge_distance_99},
      {"edge_distance_maximum", comparison.edge_distance_maximum},
      {"non_finite_pixels", comparison.non_finite_pixels},
      {"color", to_json(comparison.color)}};
  if (comparison.normal) json["normal"] = to_json(*comparison.normal);
  for (const Criterion& criterion : criteria(comparison, limits))
    json["criteria"].push_back({{"name", criterion.name},
                                {"unit", criterion.unit},
                                {"value", criterion.value},
                                {criterion.at_least ? "at_least" : "at_most", criterion.limit},
                                {"holds", criterion.holds}});
  json["failed"] = failed_criteria(comparison, limits);
  return json;
}

}  // namespace sardf
