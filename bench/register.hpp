// Benchmarks that are made in loops, so that no macro registers them.
#pragma once

namespace sardf::bench {

/// Of evaluation: one for each shape, number type and loop, and one for each operation.
void register_evaluation();
/// Of fractions and colour beside the field.
void register_fractions();
/// Of meshes.
void register_meshing();
/// Of distances to curves, surfaces and many segments.
void register_features();

}  // namespace sardf::bench
