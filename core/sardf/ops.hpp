// The one list of operations. Its families each stand in a file of their own, ops_*.hpp, whose last
// line names what it adds.
#pragma once

#include "sardf/ops_arithmetic.hpp"
#include "sardf/ops_cone.hpp"
#include "sardf/ops_domain.hpp"
#include "sardf/ops_ellipsoid.hpp"
#include "sardf/ops_features.hpp"
#include "sardf/ops_functions.hpp"
#include "sardf/ops_helix.hpp"
#include "sardf/ops_plane.hpp"
#include "sardf/ops_quadric.hpp"
#include "sardf/ops_sardf.hpp"
#include "sardf/ops_solids.hpp"
#include "sardf/ops_weights.hpp"

namespace sardf {

using Ops = Joined<SolidOps, ConeOps, EllipsoidOps, QuadricOps, PlaneOps, FeatureOps, HelixOps,
                   BlendOps, DomainOps, ArithmeticOps, FunctionOps, WeightOps>::type;

}  // namespace sardf
