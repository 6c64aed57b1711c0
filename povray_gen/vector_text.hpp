// Small pieces of POV-Ray's language.
#pragma once

#include <initializer_list>
#include <string>

#include "povray_gen/names.hpp"
#include "sardf/vec.hpp"

namespace sardf::povray {

/// <x, y, z>
std::string vector_text(const Vec3& v);

/// The text with spaces for line ends: it fits behind //.
std::string one_line(std::string text);

/// The text with every {} replaced by the next of the words.
std::string filled(const std::string& pattern, std::initializer_list<std::string> words);

}  // namespace sardf::povray
