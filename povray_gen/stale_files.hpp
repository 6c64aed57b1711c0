// Density files of an earlier run that nothing reads any more.
#pragma once

#include <string>
#include <vector>

namespace sardf::povray {

/// The paths of the density files STEM_sampled_K.df3 that the .inc at this path reads, says to hold
/// so many samples, and that lie beside it as files of just so many: written by us, with that .inc.
/// None where there is no such .inc.
std::vector<std::string> density_files_of(const std::string& include);

}  // namespace sardf::povray
