#include "sardf/bake_channels.hpp"

#include "sardf/error.hpp"

namespace sardf {

namespace {

constexpr size_t per_image = 3;

std::vector<Expression> components_of(const std::array<Expression, 3>& color) {
  return {color.begin(), color.end()};
}

void append_fractions(const Scene& scene, std::vector<BakeChannel>& channels) {
  const auto& fractions = scene.fractions();
  for (size_t first = 0; first < fractions.size(); first += per_image) {
    BakeChannel channel{"fractions_" + std::to_string(first / per_image + 1), {}};
    for (size_t m = first; m < first + per_image; ++m) {
      channel.components.push_back(m < fractions.size() ? fractions[m] : constant(0));
    }
    channels.push_back(std::move(channel));
  }
}

bool append_attribute(const Scene& scene, const std::string& name,
                      std::vector<BakeChannel>& channels) {
  for (const Attribute& attribute : scene.description().attributes) {
    if (attribute.name != name) continue;
    const size_t n = attribute.components.size();
    if (attribute.component_names.empty()) channels.push_back({name, {}});
    for (size_t c = 0; c < n; ++c) {
      // Components with names, as of a tensor, are an image each.
      if (!attribute.component_names.empty()) channels.push_back({attribute.column(c, n), {}});
      channels.back().components.push_back(attribute.components[c].expression());
    }
    return true;
  }
  return false;
}

}  // namespace

std::vector<std::string> channel_names(const Scene& scene) {
  std::vector<std::string> names(common_channels.begin(), common_channels.end());
  for (const Attribute& attribute : scene.description().attributes) {
    names.push_back(attribute.name);
  }
  return names;
}

std::vector<BakeChannel> scene_channels(const Scene& scene, const std::vector<std::string>& names) {
  std::vector<BakeChannel> channels;
  for (const std::string& name : names) {
    if (name == "base_color") {
      channels.push_back({name, components_of(scene.base_color())});
    } else if (name == "emission") {
      channels.push_back({name, components_of(scene.emission())});
    } else if (name == "roughness") {
      channels.push_back({name, {scene.roughness()}});
    } else if (name == "metallic") {
      channels.push_back({name, {scene.metallic()}});
    } else if (name == "field") {
      channels.push_back({name, {scene.solid()}});
    } else if (name == "normal") {
      channels.push_back({name, {}, true});
    } else if (name == "fractions") {
      append_fractions(scene, channels);
    } else if (!append_attribute(scene, name, channels)) {
      std::string accepted;
      for (const std::string& known : channel_names(scene)) {
        accepted += (accepted.empty() ? "" : ", ") + known;
      }
      throw Error("there is no channel '" + name + "'; accepted are " + accepted +
                  did_you_mean(name, channel_names(scene)));
    }
  }
  return channels;
}

bool is_color_channel(const std::string& name) {
  return name == "base_color" || name == "emission";
}

std::vector<std::string> materials_of_channel(const Scene& scene, const std::string& name) {
  const std::string prefix = "fractions_";
  if (!name.starts_with(prefix)) return {};
  const size_t first = (std::stoul(name.substr(prefix.size())) - 1) * per_image;
  const std::vector<std::string> all = scene.material_names();
  return {all.begin() + long(first), all.begin() + long(std::min(first + per_image, all.size()))};
}

}  // namespace sardf
