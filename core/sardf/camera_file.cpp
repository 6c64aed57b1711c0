#include "sardf/camera_file.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "sardf/error.hpp"

namespace sardf {

namespace {

using Json = nlohmann::ordered_json;

const std::vector<std::pair<const char*, double Camera::*>> numbers{
    {"lens", &Camera::lens},
    {"sensor_width", &Camera::sensor_width},
    {"sensor_height", &Camera::sensor_height},
    {"ortho_scale", &Camera::ortho_scale},
    {"shift_x", &Camera::shift_x},
    {"shift_y", &Camera::shift_y},
    {"clip_start", &Camera::clip_start},
    {"clip_end", &Camera::clip_end}};

const std::vector<std::string> types{"PERSP", "ORTHO"};
const std::vector<std::string> fits{"AUTO", "HORIZONTAL", "VERTICAL"};

int place_of(const Json& value, const std::vector<std::string>& words, const std::string& key) {
  for (size_t i = 0; i < words.size(); ++i) {
    if (value.is_string() && value.get<std::string>() == words[i]) return int(i);
  }
  throw Error(key + " is " + value.dump() + "; accepted are " + Json(words).dump());
}

Camera parse_camera(const Json& json) {
  if (!json.is_object()) throw Error("a camera is an object");
  Camera camera;
  if (!json.contains("matrix_world")) throw Error("matrix_world is missing");
  camera.matrix_world = json["matrix_world"].get<decltype(camera.matrix_world)>();
  for (const auto& [name, member] : numbers) {
    if (json.contains(name)) camera.*member = json[name].get<double>();
  }
  if (json.contains("type")) camera.type = Camera::Type(place_of(json["type"], types, "type"));
  if (json.contains("sensor_fit")) {
    camera.sensor_fit = Camera::Fit(place_of(json["sensor_fit"], fits, "sensor_fit"));
  }
  return camera;
}

}  // namespace

Camera scene_camera(const Scene& scene, int width, int height) {
  const Framing& view = scene.description().view;
  return frame_camera(scene.bounds(), width, height, -1.0 * view.direction);
}

std::string camera_text(const Camera& camera) {
  Json json;
  json["matrix_world"] = camera.matrix_world;
  json["type"] = types[size_t(camera.type)];
  json["sensor_fit"] = fits[size_t(camera.sensor_fit)];
  for (const auto& [name, member] : numbers) json[name] = camera.*member;
  return json.dump(1) + "\n";
}

Camera camera_from_text(const std::string& text) {
  try {
    return parse_camera(Json::parse(text));
  } catch (const nlohmann::json::exception& error) {
    throw Error(error.what());
  }
}

Camera read_camera(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw Error("cannot be read: " + std::string(std::strerror(errno)), path);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  try {
    return camera_from_text(text);
  } catch (const Error& error) {
    throw Error(error.message, path);
  }
}

}  // namespace sardf
