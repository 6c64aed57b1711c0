#include "sardf/cubic_solver.hpp"

namespace sardf {

CubicSolver avx512_cubic_solver() { return &cubic::Solver<cubic::Eight>::solve; }

}  // namespace sardf
