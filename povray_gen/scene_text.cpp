#include "povray_gen/scene_text.hpp"

#include <filesystem>

#include "povray_gen/isosurface_text.hpp"
#include "povray_gen/scene_samples.hpp"
#include "povray_gen/sharp_edges.hpp"
#include "povray_gen/vector_text.hpp"
#include "sardf/error.hpp"
#include "sardf/pulse.hpp"

namespace sardf::povray {

namespace {

// The share of the progress that samples take; the rest goes into the pieces.
constexpr double share_of_samples = 0.8;
// Half the step of our central differences: rounding and curvature both stay below 1e-9.
constexpr double normal_step = 1e-5;

// The identifiers that users meet, reserved before any field takes one.
struct Identifiers {
  explicit Identifiers(Names& names)
      : guard(names.unique("inc")),
        csg(names.unique("csg")),
        isosurface(names.unique("isosurface")),
        pigment(names.unique("pigment")),
        normal_pigment(names.unique("normal_pigment")),
        texture(names.unique("texture")),
        object(names.unique("object")) {}
  std::string guard, csg, isosurface, pigment, normal_pigment, texture, object;
};

void check_bounds(const BoundingBox& bounds) {
  for (int i = 0; i < 3; ++i) {
    const double size = bounds.hi[i] - bounds.lo[i];
    if (!(size > 0 && size < infinity)) {
      throw Error("POV-Ray needs a bounded solid; its bounds have the size " +
                  std::to_string(size) + " along " + "xyz"[i]);
    }
  }
}

// A pigment of three functions. POV-Ray 3.7 has none, but the average of three pigments that are
// pure red, green and blue, three times as bright. Values just beyond [0, 1] would wrap around.
std::string three_function_pigment(const std::string& name,
                                   const std::array<std::string, 3>& functions) {
  constexpr const char* ends[] = {"<3, 0, 0>", "<0, 3, 0>", "<0, 0, 3>"};
  std::string out = "#declare " + name + " = pigment {\n  average pigment_map {\n";
  for (int i = 0; i < 3; ++i) {
    out += filled(
        "    [1 function { min(1, max(0, {}(x, y, z))) } color_map { [0 rgb 0] [1 rgb {}] }]\n",
        {functions[i], ends[i]});
  }
  return out + "  }\n}\n";
}

// Of two or three materials whose fractions sum to 1: the first one's colour, and for each other
// fraction the way from it, as an average of pigments. One function or two instead of three.
std::string mixed_pigment(const std::string& name, const PovrayScene& scene,
                          FunctionWriter& writer) {
  const std::vector<Vec3>& colors = scene.material_colors;
  const auto others = double(colors.size() - 1);
  std::string out;
  for (size_t i = 1; i < colors.size(); ++i) {
    const std::string function =
        writer.declare({"fraction_" + scene.fractions[i].name, scene.fractions[i].expression});
    out += filled(
        "    [1 function { min(1, max(0, {}(x, y, z))) } color_map { [0 rgb {}] [1 rgb {}] }]\n",
        {function, vector_text(colors[0]),
         vector_text(colors[0] + others * (colors[i] - colors[0]))});
  }
  return "#declare " + name + " = pigment {\n  average pigment_map {\n" + out + "  }\n}\n";
}

// Samples' errors are stated of the channels.
bool is_mixed(const SceneSamples& samples) {
  const size_t materials = samples.scene.material_colors.size();
  return samples.functions.empty() && materials == samples.scene.fractions.size() &&
         (materials == 2 || materials == 3);
}

std::string color_pigment(const SceneSamples& samples, const std::string& name,
                          FunctionWriter& writer) {
  const std::array<Expression, 3>& color = samples.scene.color;
  Vec3 even{0.8, 0.8, 0.8};
  bool is_even = true;
  for (int i = 0; i < 3; ++i) {
    if (!color[i]) continue;
    is_even = is_even && is_constant(color[i]);
    even[i] = color[i]->value;
  }
  if (is_even) return "#declare " + name + " = pigment { rgb " + vector_text(even) + " }\n";
  if (is_mixed(samples)) return mixed_pigment(name, samples.scene, writer);
  const std::vector<std::string> functions =
      writer.declare(std::vector<NamedExpression>{{"red", color[0], samples.color_comments[0]},
                                                  {"green", color[1], samples.color_comments[1]},
                                                  {"blue", color[2], samples.color_comments[2]}});
  return comment_lines(samples.fractions_comment) +
         three_function_pigment(name, {functions[0], functions[1], functions[2]});
}

// The function decreases outwards: central differences, backward minus forward, point outwards.
std::string normal_pigment(const std::string& name, const std::string& function, double step,
                           Names& names) {
  const std::string h = number_text(step);
  constexpr const char* axes[] = {"x", "y", "z"};
  constexpr const char* shifted[] = {"{}(x - {}, y, z) - {}(x + {}, y, z)",
                                     "{}(x, y - {}, z) - {}(x, y + {}, z)",
                                     "{}(x, y, z - {}) - {}(x, y, z + {})"};
  std::array<std::string, 3> slopes, colors;
  std::string out;
  for (int i = 0; i < 3; ++i) {
    slopes[i] = names.unique(std::string("slope_").append(axes[i]));
    out += "#declare " + slopes[i] + " = function(x, y, z) {\n  " +
           filled(shifted[i], {function, h, function, h}) + "\n}\n";
  }
  const std::string unit = names.unique("unit");
  const std::string a = names.parameter(0), b = names.parameter(1), c = names.parameter(2);
  out += filled(
      "#declare {} = function({}, {}, {}) {\n"
      "  0.5 + 0.5 * {} / sqrt(max({} * {} + {} * {} + {} * {}, 1e-300))\n}\n",
      {unit, a, b, c, a, a, a, b, b, c, c});
  for (int i = 0; i < 3; ++i) {
    colors[i] = names.unique(std::string("normal_").append(axes[i]));
    // The component in question comes first; the others only count towards the length.
    out += filled(
        "#declare {} = function(x, y, z) {\n  {}({}(x, y, z), {}(x, y, z), {}(x, y, z))\n}\n",
        {colors[i], unit, slopes[i], slopes[(i + 1) % 3], slopes[(i + 2) % 3]});
  }
  return out + three_function_pigment(name, colors);
}

std::string include_text(const SceneSamples& samples, Names& names, const Identifiers& ids,
                         const GradientBound& whole, const GradientBound& drawn,
                         const std::vector<Piece>& pieces) {
  FunctionWriter writer(names);
  const PovrayScene& scene = samples.scene;
  std::vector<NamedExpression> all(scene.fields);
  all.push_back({"solid", scene.solid, samples.solid_comment});
  const std::string solid = writer.declare(all).back();
  const std::vector<std::string> near = texts_of_pieces(pieces, writer);
  const std::string pigment = color_pigment(samples, ids.pigment, writer);
  const double step = normal_step * scene.bounds.diagonal();
  std::string out = filled(
      "// {}\n"
      "//\n"
      "// object { {} } is the solid in its colours. {}() is the solid alone\n"
      "// and {} its colours, for a texture of your own. Fields are functions of x, y, z,\n"
      "// positive inside.\n"
      "{}//\n"
      "// To use it in difference, intersection, merge or clipped_by, write\n"
      "//   #declare {} = yes;\n"
      "// before including this file, so that all intersections are found (at most 10 on a ray), "
      "and\n"
      "// give the texture to the outermost object: a cut face has that one's texture, or none.\n"
      "#ifndef ({})\n#declare {} = version;\n#version 3.7;\n"
      "#ifndef ({}) #declare {} = no; #end\n\n",
      {one_line(scene.title), ids.object, ids.isosurface, ids.pigment,
       comment_lines(one_line(samples.left_out_sentence())), ids.csg, ids.guard, ids.guard, ids.csg,
       ids.csg});
  out += writer.text() + "\n" +
         isosurface_macro(scene, ids.isosurface, ids.csg, solid, whole, drawn, pieces, near) +
         pigment + normal_pigment(ids.normal_pigment, solid, step, names);
  out += filled(
      "#declare {} = texture {\n  pigment { {} }\n"
      "  finish { ambient 0.1 diffuse 0.8 specular 0.15 roughness 0.03 }\n}\n"
      "#declare {} = object { {}() texture { {} } }\n\n"
      "#version {};\n#end\n",
      {ids.texture, ids.pigment, ids.object, ids.isosurface, ids.texture, ids.guard});
  return out;
}

// A large soft key light over the camera's left shoulder, a weak fill from its right and one from
// below behind, both without shadows and highlights.
std::string lights_text(const PovrayScene& scene) {
  const View view = view_of(scene.camera, scene.width, scene.height);
  const Vec3 right = normalized(view.right), up = normalized(view.up);
  const Vec3 back = -1.0 * normalized(view.direction);
  const double size = scene.bounds.diagonal();
  const Vec3 center = scene.bounds.center();
  const auto at = [&](double r, double u, double b) {
    return vector_text(center + 3 * size * (r * right + u * up + b * back));
  };
  return filled(
      "light_source {\n  {}, rgb 0.95\n"
      "  area_light {}, {}, 3, 3 adaptive 0 circular orient\n}\n"
      "light_source { {}, rgb 0.3 shadowless }\n"
      "light_source { {}, rgb 0.2 shadowless }\n",
      {at(-0.6, 0.9, 0.8), vector_text(0.6 * size * right), vector_text(0.6 * size * up),
       at(1, 0.1, 0.6), at(0.2, -0.7, -0.5)});
}

}  // namespace

std::string camera_text(const Camera& camera, int width, int height) {
  const View view = view_of(camera, width, height);
  return filled("camera {\n{}  location {}\n  right {}\n  up {}\n  direction {}\n}\n",
                {camera.type == Camera::Type::orthographic ? "  orthographic\n" : "",
                 vector_text(view.location), vector_text(view.right), vector_text(view.up),
                 vector_text(view.direction)});
}

SceneText scene_text(const PovrayScene& exact_scene, const std::string& include_name,
                     const SamplingOptions& sampling) {
  check_bounds(exact_scene.bounds);
  if (include_name.find('"') != std::string::npos) {
    throw Error("POV-Ray cannot include a file whose name has a quotation mark", include_name);
  }
  SceneText out;
  SamplingOptions first = sampling;
  first.progress = part_of(sampling.progress, 0, share_of_samples);
  const SceneSamples samples =
      sample_scene(exact_scene, std::filesystem::path(include_name).stem(), first);
  const PovrayScene& scene = samples.scene;
  out.sampled = samples.functions;
  out.errors = samples.errors;
  out.sentences = samples.sentences();
  const bool exact = scene.solid == exact_scene.solid;
  const GradientBound whole = gradient_of(scene, exact);
  PovrayScene sharp = scene;
  sharp.solid = with_sharp_edges(scene.solid);
  const GradientBound drawn = sharp.solid == scene.solid ? whole : gradient_of(sharp, exact);
  const std::vector<Piece> pieces =
      isosurface_pieces(sharp, drawn, part_of(sampling.progress, share_of_samples, 1));
  const GradientBound largest = pieces.size() == 1 ? smaller(pieces[0], drawn) : whole;
  Names names(scene.title);
  const Identifiers ids(names);
  out.prefix = names.prefix();
  out.max_gradient = gradient_margin * largest.value;
  out.proven = largest.proven;
  out.include = include_text(samples, names, ids, whole, drawn, pieces);
  out.scene =
      filled("// {}\n#version 3.7;\nglobal_settings { assumed_gamma 1.0 }\n#include \"{}\"\n\n",
             {one_line(scene.title), include_name});
  out.scene += camera_text(scene.camera, scene.width, scene.height);
  if (scene.look == Look::shaded) {
    out.scene += "background { rgb " + vector_text(scene.background) + " }\n" + lights_text(scene) +
                 "object { " + ids.object + " }\n";
  } else {
    // Transparent: with +UA the picture's alpha is the mask of the object.
    out.scene += filled(
        "background { rgbt 1 }\nobject {\n  {}()\n  texture {\n    pigment { {} }\n"
        "    finish { ambient 0 diffuse 0 emission 1 }\n  }\n}\n",
        {ids.isosurface, scene.look == Look::flat ? ids.pigment : ids.normal_pigment});
  }
  return out;
}

}  // namespace sardf::povray
