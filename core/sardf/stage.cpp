#include "sardf/stage.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numbers>

#include "sardf/camera_file.hpp"
#include "sardf/error.hpp"
#include "sardf/scene_file.hpp"

namespace sardf {

namespace {

using Json = nlohmann::ordered_json;
using Names = std::vector<std::string>;

constexpr double pi = std::numbers::pi;

// A number of a light, and the values that are accepted.
struct Number {
  const char* key;
  double Light::*member;
  double low, high;
  bool open = false;  // the lower end is not accepted
};

const std::vector<Number> numbers{{"power", &Light::power, -infinity, infinity},
                                  {"radius", &Light::radius, 0, infinity},
                                  {"angle", &Light::angle, 0, pi},
                                  {"spot_size", &Light::spot_size, 0, pi, true},
                                  {"spot_blend", &Light::spot_blend, 0, 1},
                                  {"size_x", &Light::size_x, 0, infinity, true},
                                  {"size_y", &Light::size_y, 0, infinity, true}};
const Names light_types{"point", "sun", "spot", "area"}, shapes{"rectangle", "ellipse"};
const Names light_keys{"name",   "type",      "matrix_world", "color",       "power",  "radius",
                       "angle",  "spot_size", "spot_blend",   "shape",       "size_x", "size_y",
                       "shadow", "tint",      "exposure",     "soft_falloff"};

[[noreturn]] void fail(const std::string& text, const std::string& pointer) {
  throw Error(text, "", 0, pointer);
}

void check_keys(const Json& json, const Names& accepted, const std::string& at) {
  if (!json.is_object()) fail("expected an object, found " + json.dump().substr(0, 40), at);
  for (const auto& [key, value] : json.items()) {
    if (std::find(accepted.begin(), accepted.end(), key) != accepted.end()) continue;
    fail("there is no key '" + key + "'; accepted are " + Json(accepted).dump() +
             did_you_mean(key, accepted),
         at);
  }
}

double number_of(const Json& json, const std::string& at) {
  if (!json.is_number() || !std::isfinite(json.get<double>())) {
    fail("expected a finite number, found " + json.dump().substr(0, 40), at);
  }
  return json.get<double>();
}

template <size_t n>
std::array<double, n> numbers_of(const Json& json, const std::string& at) {
  if (!json.is_array() || json.size() != n) {
    fail("expected a list of " + std::to_string(n) + " numbers, found " + json.dump().substr(0, 40),
         at);
  }
  std::array<double, n> out{};
  for (size_t i = 0; i < n; ++i) out[i] = number_of(json[i], at + "/" + std::to_string(i));
  return out;
}

// A matrix whose axes do not lie in a plane: a light must know where it shines, a part has a size.
Matrix4 matrix_of(const Json& json, const std::string& at) {
  if (!json.is_array() || json.size() != 4) fail("expected a matrix of 4 rows", at);
  Matrix4 out{};
  for (size_t i = 0; i < 4; ++i) out[i] = numbers_of<4>(json[i], at + "/" + std::to_string(i));
  const auto axis = [&](int j) { return Vec3{out[0][j], out[1][j], out[2][j]}; };
  if (!(std::abs(dot(cross(axis(0), axis(1)), axis(2))) > 0)) {
    fail("the matrix has a scale of 0", at);
  }
  return out;
}

bool truth_of(const Json& json, const std::string& at) {
  if (!json.is_boolean()) fail("expected true or false, found " + json.dump().substr(0, 40), at);
  return json;
}

size_t word_of(const Json& json, const Names& accepted, const std::string& at) {
  const std::string word = json.is_string() ? json.get<std::string>() : json.dump().substr(0, 40);
  const auto found = std::find(accepted.begin(), accepted.end(), word);
  if (found == accepted.end()) {
    fail("found '" + word + "'; accepted are " + Json(accepted).dump() +
             did_you_mean(word, accepted),
         at);
  }
  return size_t(found - accepted.begin());
}

Light light_of(const Json& json, const std::string& at) {
  check_keys(json, light_keys, at);
  Light light;
  if (!json.contains("type")) fail("the light has no type", at);
  light.type = Light::Type(word_of(json["type"], light_types, at + "/type"));
  if (json.contains("name") && json["name"].is_string()) light.name = json["name"];
  if (json.contains("shape")) {
    light.shape = Light::Shape(word_of(json["shape"], shapes, at + "/shape"));
  }
  if (json.contains("matrix_world")) {
    light.matrix_world = matrix_of(json["matrix_world"], at + "/matrix_world");
  }
  if (json.contains("color")) light.color = numbers_of<3>(json["color"], at + "/color");
  if (json.contains("shadow")) light.shadow = truth_of(json["shadow"], at + "/shadow");
  if (json.contains("soft_falloff")) {
    light.soft_falloff = truth_of(json["soft_falloff"], at + "/soft_falloff");
  }
  for (const Number& number : numbers) {
    if (!json.contains(number.key)) continue;
    const std::string place = at + "/" + number.key;
    const double value = light.*number.member = number_of(json[number.key], place);
    if (value < number.low || value > number.high || (number.open && value == number.low)) {
      fail(std::string(number.key) + " is " + json[number.key].dump() + "; it must be " +
               (number.open ? "above " : "at least ") + Json(number.low).dump() +
               (number.high < infinity ? " and at most " + Json(number.high).dump() : ""),
           place);
    }
  }
  if (json.contains("tint")) {
    const Vec3 tint = numbers_of<3>(json["tint"], at + "/tint");
    for (size_t i = 0; i < 3; ++i) light.color[i] *= tint[i];
  }
  if (json.contains("exposure")) {
    light.power *= std::exp2(number_of(json["exposure"], at + "/exposure"));
  }
  return light;
}

// What lights of this version of Blender do.
void follow(Light& light, const std::array<double, 3>& blender) {
  if (blender[0] >= 4) return;
  if (light.type == Light::Type::area) light.power *= pi / 4;
  light.spot_cosine = light.type == Light::Type::spot;
}

StagePart part_of_stage(const Json& json, const std::string& at, const std::string& file,
                        const Progress& progress) {
  check_keys(json, {"scene", "matrix_world"}, at);
  if (!json.contains("scene")) fail("the part has no scene", at);
  StagePart part;
  if (json.contains("matrix_world")) {
    part.matrix_world = matrix_of(json["matrix_world"], at + "/matrix_world");
  }
  const ProgressScope scope(progress);
  const Json& scene = json["scene"];
  namespace fs = std::filesystem;
  SceneDescription description =
      scene.is_string() ? read_scene(fs::path(file).parent_path() / scene.get<std::string>())
                        : parse_scene(scene.dump(), file);
  part.scene = std::make_shared<const Scene>(std::move(description), progress);
  return part;
}

Vec3 world_of(const Json& json) {
  check_keys(json, {"color", "strength"}, "/world");
  if (!json.contains("color")) fail("the world has no color", "/world");
  const Vec3 color = numbers_of<3>(json["color"], "/world/color");
  return (json.contains("strength") ? number_of(json["strength"], "/world/strength") : 1) * color;
}

Stage parsed(const Json& json, const std::string& file, const Progress& progress) {
  check_keys(json, {"camera", "world", "lights", "parts", "blender"}, "");
  Stage stage;
  if (!json.contains("camera")) fail("the stage has no camera", "");
  stage.camera = camera_from_text(json["camera"].dump());
  if (json.contains("world")) stage.world = world_of(json["world"]);
  std::array<double, 3> blender{5, 0, 0};
  if (json.contains("blender")) blender = numbers_of<3>(json["blender"], "/blender");
  for (const char* list : {"lights", "parts"}) {
    if (json.contains(list) && !json[list].is_array()) {
      fail("expected a list", std::string("/") + list);
    }
  }
  const Json nothing = Json::array();
  const Json& lights = json.contains("lights") ? json["lights"] : nothing;
  for (size_t i = 0; i < lights.size(); ++i) {
    stage.lights.push_back(light_of(lights[i], "/lights/" + std::to_string(i)));
    follow(stage.lights.back(), blender);
  }
  const Json& parts = json.contains("parts") ? json["parts"] : nothing;
  if (parts.empty()) fail("the stage has no parts", "/parts");
  for (size_t i = 0; i < parts.size(); ++i) {
    stage.parts.push_back(part_of_stage(parts[i], "/parts/" + std::to_string(i), file, progress));
  }
  return stage;
}

}  // namespace

Stage stage_from_text(const std::string& text, const std::string& file, const Progress& progress) {
  try {
    return parsed(Json::parse(text, nullptr, true, true), file, progress);
  } catch (const nlohmann::json::exception& error) {
    throw Error(error.what(), file);
  } catch (const SceneErrors&) {
    throw;
  } catch (const Error& error) {
    if (!error.file.empty()) throw;
    throw Error(error.message, file, error.line, error.pointer);
  }
}

Stage read_stage(const std::string& path, const Progress& progress) {
  std::ifstream file(path);
  if (!file) throw Error("cannot be read: " + std::string(std::strerror(errno)), path);
  return stage_from_text({std::istreambuf_iterator<char>(file), {}}, path, progress);
}

}  // namespace sardf
