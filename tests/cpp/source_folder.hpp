// Where the repository is. Only source_folder.cpp knows it when it is compiled: checkouts of one
// state share all other objects.
#pragma once

#include <filesystem>

namespace sardf {

const std::filesystem::path& source_folder();

}  // namespace sardf
