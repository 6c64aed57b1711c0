// A comparison as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "sardf/compare_images.hpp"

namespace sardf {

/// All numbers, the criteria with value, limit and verdict, and "passes".
nlohmann::ordered_json to_json(const Comparison& comparison, const Limits& limits);

}  // namespace sardf
