#include "sardf/cubic_solver.hpp"

namespace sardf {

CubicSolver avx2_cubic_solver() { return &cubic::Solver<cubic::Four>::solve; }

}  // namespace sardf
