#include "povray_gen/isosurface_text.hpp"

#include <unordered_map>

#include "povray_gen/scene_text.hpp"
#include "povray_gen/vector_text.hpp"
#include "sardf/error.hpp"
#include "sardf/smooth_formula.hpp"

namespace sardf::povray {

namespace {

std::string one_isosurface(const std::string& value, const BoundingBox& box,
                           const GradientBound& gradient, double accuracy,
                           const std::string& kind) {
  return filled(
      "  isosurface {\n"
      "    function { {} }\n"
      "    contained_by { box { {}, {} } }\n"
      "    accuracy {}\n"
      "    max_gradient {} // 1.02 x the bound of the gradient, {}\n"
      "    {}\n  }\n",
      {value, vector_text(box.lo), vector_text(box.hi), number_text(accuracy),
       number_text(gradient_margin * gradient.value),
       gradient.proven ? "proven" : "stated by the scene, not proven", kind});
}

// POV-Ray's inside is where the function is negative.
std::string negative(const std::string& value, double band) {
  if (!(band < infinity)) return "-(" + value + ")";
  const std::string most = number_text(band);
  return "min(" + most + ", max(-" + most + ", -(" + value + ")))";
}

}  // namespace

GradientBound gradient_of(const PovrayScene& scene, bool exact) {
  const CertifiedBound bound =
      certified_lipschitz(Evaluator(with_smooth_bounds(scene.solid)), scene.bounds);
  const std::optional<double>& stated = scene.stated_lipschitz;
  if (bound.value < infinity && !exact) return {bound.value, true};
  if (stated && !(bound.value <= *stated)) return {*stated, false};
  if (bound.value < infinity) return {bound.value, true};
  const std::string at = certified_lipschitz(Evaluator(scene.solid), scene.bounds).infinite_at;
  throw Error("POV-Ray needs a bound of the solid's gradient, and '" + at +
              "' has none; rewrite it, or state one: \"lipschitz\": L");
}

GradientBound smaller(const Piece& piece, const GradientBound& whole) {
  return piece.gradient <= whole.value ? GradientBound{piece.gradient, true} : whole;
}

std::vector<Piece> isosurface_pieces(const PovrayScene& scene, const GradientBound& whole,
                                     const Progress& progress) {
  PieceOptions options;
  options.gradient = whole.value;
  options.accuracy = isosurface_accuracy * scene.bounds.diagonal();
  // POV-Ray does not look at a ray that passes less than the accuracy of a box: all that lies near
  // an edge lies deeper in another piece.
  options.overlap = 4 * options.accuracy;
  // POV-Ray's own normals are differences over the accuracy.
  options.reach = 4 * options.accuracy;
  // What the formula is worth further from the surface shows nowhere.
  options.exact_within = 2 * options.reach * whole.value;
  options.progress = progress;
  return pieces_of(scene.solid, scene.bounds, options);
}

std::vector<std::string> texts_of_pieces(const std::vector<Piece>& pieces, FunctionWriter& writer) {
  std::unordered_map<const Node*, std::string> known;
  std::vector<std::string> out;
  for (const Piece& piece : pieces) {
    std::string& text = known[piece.solid.get()];
    if (text.empty()) text = writer.quick("solid_near", piece.solid);
    out.push_back(text);
  }
  return out;
}

std::string isosurface_macro(const PovrayScene& scene, const std::string& name,
                             const std::string& csg, const std::string& solid,
                             const GradientBound& whole, const GradientBound& drawn,
                             const std::vector<Piece>& pieces,
                             const std::vector<std::string>& texts) {
  const double accuracy = isosurface_accuracy * scene.bounds.diagonal();
  // A macro, because copies of a declared isosurface do not report a max_gradient that is too
  // small.
  std::string out = "#macro " + name + "()\n";
  const auto closed = [&](const std::string& text, const Piece& piece, const GradientBound& bound) {
    return one_isosurface(negative(text, piece.band), piece.box, smaller(piece, bound), accuracy,
                          "#if (" + csg + ") all_intersections #end");
  };
  if (pieces.size() == 1) return out + closed(texts[0], pieces[0], drawn) + "#end\n";
  out += "#if (" + csg + ")\n" + closed(solid + "(x, y, z)", {scene.bounds, scene.solid}, whole) +
         "#else\n  // The surface passes through these boxes only.\n" + "  union {\n";
  for (size_t i = 0; i < pieces.size(); ++i) {
    out += one_isosurface(negative(texts[i], pieces[i].band), pieces[i].box,
                          smaller(pieces[i], drawn), accuracy, "open");
  }
  return out + "  }\n#end\n#end\n";
}

}  // namespace sardf::povray
