// The channels that a scene offers to the baker, by name.
#pragma once

#include <string>
#include <vector>

#include "sardf/bake.hpp"
#include "sardf/scene.hpp"

namespace sardf {

/// base_color (3 components), roughness, metallic, emission (3), fractions, field, normal (3),
/// density where every material states one, and attributes by name. "fractions" becomes
/// fractions_1, fractions_2, ... of three materials each, in order, 0 where there is none. Throws
/// Error with the nearest name for any other.
std::vector<BakeChannel> scene_channels(const Scene& scene, const std::vector<std::string>& names);

/// All names that scene_channels accepts for this scene.
std::vector<std::string> channel_names(const Scene& scene);

struct ChannelInfo {
  std::string name;
  /// What its values are, in a few words.
  std::string doc;
};

/// The same with what they are; those of every scene first, then attributes.
std::vector<ChannelInfo> channel_infos(const Scene& scene);

/// Whether a channel holds linear colours; all others are data.
bool is_color_channel(const std::string& name);

/// The materials in fractions_1, fractions_2, ...: "fractions_1" holds the first three.
std::vector<std::string> materials_of_channel(const Scene& scene, const std::string& name);

}  // namespace sardf
