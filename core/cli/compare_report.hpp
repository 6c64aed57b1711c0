// The comparison of renders as one page: pictures, differences, numbers, verdicts.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "sardf/compare_images.hpp"
#include "sardf/image_file.hpp"

namespace sardf {

/// One picture from both renderers, of one size. `meaning` says how it is shown: linear colour as
/// sRGB, data (normals) as it is. Only the first three channels are shown.
struct ReportPicture {
  std::string name;  // "Colour", "Normal"
  Image reference;
  Image candidate;
  Image difference;
  Meaning meaning = Meaning::color;
};

/// With the difference times 16.
ReportPicture report_picture(const std::string& name, Image reference, Image candidate,
                             Meaning meaning);

/// A column of the report: one candidate against the reference.
struct ReportView {
  std::string label;  // "Blender 3.4.1"
  std::vector<ReportPicture> pictures;
  Comparison numbers;
  Limits limits;
};

/// All views of a scene have the same pictures in the same order.
struct ReportScene {
  std::string title;
  std::string description;
  std::vector<std::pair<std::string, std::string>> facts;  // "Size", "640 x 480"; "POV-Ray", "7 s"
  std::string reference_label = "POV-Ray";
  std::vector<ReportView> views;
};

/// One HTML page that needs nothing else: pictures as PNG data, no script. Where the pointer is
/// over a candidate (or it is clicked) the reference shows in its place.
std::string report_page(const std::string& title, const std::vector<ReportScene>& scenes);

/// The page as a file, written to a temporary name that is then renamed. Throws Error naming it.
void write_report(const std::string& path, const std::string& title,
                  const std::vector<ReportScene>& scenes);

}  // namespace sardf
