#include "sardf/bake_channels.hpp"

#include <algorithm>

#include "sardf/error.hpp"
#include "sardf/inverse_shares.hpp"

namespace sardf {

namespace {

constexpr size_t per_image = 3;
constexpr const char* density = "density";

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

bool states_density(const Scene& scene) {
  const std::vector<Material>& materials = scene.description().materials;
  return !materials.empty() && std::all_of(materials.begin(), materials.end(),
                                           [](const Material& m) { return m.density.has_value(); });
}

// An attribute of that name comes first: it is what the scene means by the word.
bool has_density(const Scene& scene) {
  const std::vector<Attribute>& attributes = scene.description().attributes;
  return states_density(scene) &&
         std::none_of(attributes.begin(), attributes.end(),
                      [](const Attribute& attribute) { return attribute.name == density; });
}

// In g/cm³, where every material states it.
Expression density_of(const Scene& scene) {
  std::vector<double> factors;
  for (const Material& m : scene.description().materials) factors.push_back(*m.density);
  return weighted_sum(scene.fractions(), factors);
}

std::string doc_of(const Attribute& attribute) {
  const size_t n = attribute.components.size();
  std::string doc = n == 1 ? "attribute: a number" : "attribute: " + std::to_string(n) + " numbers";
  if (!attribute.component_names.empty()) doc += ", an image for each";
  return attribute.unit.empty() ? doc : doc + "; in " + attribute.unit;
}

}  // namespace

std::vector<std::string> channel_names(const Scene& scene) {
  std::vector<std::string> names;
  for (const ChannelInfo& info : channel_infos(scene)) names.push_back(info.name);
  return names;
}

std::vector<ChannelInfo> channel_infos(const Scene& scene) {
  std::vector<ChannelInfo> infos;
  for (const auto& [name, doc] : common_channels) infos.push_back({name, doc});
  if (has_density(scene)) infos.push_back({density, "the materials' density, mixed; in g/cm³"});
  for (const Attribute& attribute : scene.description().attributes)
    infos.push_back({attribute.name, doc_of(attribute)});
  return infos;
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
    } else if (name == density && has_density(scene)) {
      channels.push_back({name, {density_of(scene)}});
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
