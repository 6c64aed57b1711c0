#include "povray_gen/isosurface_text.hpp"

#include <unordered_map>

#include "povray_gen/scene_text.hpp"
#include "povray_gen/vector_text.hpp"
#include "sardf/error.hpp"

namespace sardf::povray {

namespace {

std::string one_isosurface(const std::string& function, const BoundingBox& box,
                           const GradientBound& gradient, double accuracy,
                           const std::string& kind) {
  // POV-Ray's inside is where the function is negative.
  return filled(
      "  isosurface {\n"
      "    function { -({}(x, y, z)) }\n"
      "    contained_by { box { {}, {} } }\n"
      "    accuracy {}\n"
      "    max_gradient {} // 1.02 x the bound of the gradient, {}\n"
      "    {}\n  }\n",
      {function, vector_text(box.lo), vector_text(box.hi), number_text(accuracy),
       number_text(gradient_margin * gradient.value),
       gradient.proven ? "proven" : "stated by the scene, not proven", kind});
}

// A piece's own bound is proven, or else that of the whole counts.
GradientBound smaller(const CertifiedBound& own, const GradientBound& whole) {
  return own.value <= whole.value ? GradientBound{own.value, true} : whole;
}

}  // namespace

GradientBound gradient_of(const PovrayScene& scene, bool exact) {
  const CertifiedBound bound = certified_lipschitz(Evaluator(scene.solid), scene.bounds);
  const std::optional<double>& stated = scene.stated_lipschitz;
  if (bound.value < infinity && !exact) return {bound.value, true};
  if (stated && !(bound.value <= *stated)) return {*stated, false};
  if (bound.value < infinity) return {bound.value, true};
  throw Error("POV-Ray needs a bound of the solid's gradient, and '" + bound.infinite_at +
              "' has none; rewrite it, or state one: \"lipschitz\": L");
}

std::vector<Piece> isosurface_pieces(const PovrayScene& scene, const Progress& progress) {
  PieceOptions options;
  options.accuracy = isosurface_accuracy * scene.bounds.diagonal();
  // POV-Ray does not look at a ray that passes less than the accuracy of a box: all that lies near
  // an edge lies deeper in another piece.
  options.overlap = 4 * options.accuracy;
  // POV-Ray's own normals are differences over the accuracy.
  options.reach = 4 * options.accuracy;
  options.progress = progress;
  return pieces_of(scene.solid, scene.bounds, options);
}

std::vector<std::string> declare_pieces(const std::vector<Piece>& pieces, FunctionWriter& writer,
                                        const Expression& whole, const std::string& solid) {
  std::unordered_map<const Node*, std::string> known{{whole.get(), solid}};
  std::vector<std::string> out;
  for (const Piece& piece : pieces) {
    std::string& name = known[piece.solid.get()];
    if (name.empty()) name = writer.declare({"solid_near", piece.solid});
    out.push_back(name);
  }
  return out;
}

std::string isosurface_macro(const PovrayScene& scene, const std::string& name,
                             const std::string& csg, const std::string& solid,
                             const GradientBound& whole, const std::vector<Piece>& pieces,
                             const std::vector<std::string>& functions) {
  const double accuracy = isosurface_accuracy * scene.bounds.diagonal();
  // A macro, because copies of a declared isosurface do not report a max_gradient that is too
  // small.
  std::string out = "#macro " + name + "()\n";
  const std::string all = one_isosurface(solid, scene.bounds, whole, accuracy,
                                         "#if (" + csg + ") all_intersections #end");
  if (pieces.size() == 1) return out + all + "#end\n";
  out += "#if (" + csg + ")\n" + all +
         "#else\n  // The surface passes through these boxes only.\n" + "  union {\n";
  for (size_t i = 0; i < pieces.size(); ++i) {
    out += one_isosurface(functions[i], pieces[i].box, smaller(pieces[i].gradient, whole), accuracy,
                          "open");
  }
  return out + "  }\n#end\n#end\n";
}

}  // namespace sardf::povray
