// The solid as POV-Ray draws it: an isosurface, or several that share its surface among them.
#pragma once

#include <string>
#include <vector>

#include "povray_gen/function_text.hpp"
#include "povray_gen/pieces.hpp"

namespace sardf::povray {

struct PovrayScene;

/// Positions are found, and POV-Ray's own normals differenced, to this share of the bounds'
/// diagonal.
inline constexpr double isosurface_accuracy = 1e-5;
/// max_gradient is the bound times this.
inline constexpr double gradient_margin = 1.02;

struct GradientBound {
  double value = 0;
  bool proven = true;  ///< false: stated by the scene
};

/// A bound of the solid's gradient within the bounds. `exact`: nothing in the solid is sampled;
/// else what the user states of it does not hold for the interpolated samples. Throws Error naming
/// the operation at fault where the bound is infinite and none is stated.
GradientBound gradient_of(const PovrayScene& scene, bool exact);

/// The pieces that POV-Ray traces fastest (pieces.hpp); `whole`: the bound of the solid's gradient.
/// Cancelled.
std::vector<Piece> isosurface_pieces(const PovrayScene& scene, const GradientBound& whole,
                                     const Progress& progress);

/// The bound that counts in a piece: its own is proven.
GradientBound smaller(const Piece& piece, const GradientBound& whole);

/// Declares a macro `name` without parameters that gives the solid: one isosurface if the
/// identifier `csg` is true there, else a union of the pieces. `solid`: the function of the whole;
/// `whole`: the bound of its gradient; `drawn`: that of the field that the pieces are of; `texts`:
/// the fields of the pieces.
std::string isosurface_macro(const PovrayScene& scene, const std::string& name,
                             const std::string& csg, const std::string& solid,
                             const GradientBound& whole, const GradientBound& drawn,
                             const std::vector<Piece>& pieces,
                             const std::vector<std::string>& texts);

/// The fields of the pieces as text in x, y and z; what helper functions they need is declared.
std::vector<std::string> texts_of_pieces(const std::vector<Piece>& pieces, FunctionWriter& writer);

}  // namespace sardf::povray
