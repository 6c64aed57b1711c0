#include "cli/render_povray.hpp"

#include <algorithm>

#include "sardf/compare_images.hpp"

namespace sardf {

namespace {

// POV-Ray calls a picture of nothing a success.
std::string empty_picture(const std::string& path) {
  const Image image = read_image(path, Meaning::color);
  const Mask mask = mask_from_alpha(image);
  const bool any = std::any_of(mask.begin(), mask.end(), [](unsigned char m) { return m != 0; });
  return any ? "" : "the picture shows nothing of the object";
}

}  // namespace

void render_povray(const povray::SceneFiles& files, const std::string& image,
                   const Progress& progress) {
  const bool has_alpha = files.look != "shaded";
  povray::render_files(
      files, image, progress,
      has_alpha ? empty_picture : std::function<std::string(const std::string&)>());
}

}  // namespace sardf
