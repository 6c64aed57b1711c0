#include "cli/compare_report.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "cli/compare_report_style.hpp"
#include "cli/write_text.hpp"
#include "sardf/error.hpp"

namespace sardf {

namespace {

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '>')
      result += "&gt;";
    else if (c == '"')
      result += "&quot;";
    else
      result += c;
  }
  return result;
}

std::string base64(const std::string& bytes) {
  constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    unsigned group = 0;
    for (size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? digits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

std::string number(double value, const char* format) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

// Alpha is left away: colour multiplied by alpha is the picture before black, as both renderers'
// backgrounds are.
std::string data_uri(const Image& image, Meaning meaning) {
  Image shown{image.width, image.height, 3, {}};
  shown.samples.reserve(size_t(image.width) * image.height * 3);
  for (size_t i = 0; i + 3 <= image.samples.size(); i += size_t(image.channels))
    shown.samples.insert(shown.samples.end(), &image.samples[i], &image.samples[i] + 3);
  return "data:image/png;base64," + base64(encode_png(shown, meaning));
}

std::string img(const Image& image, Meaning meaning, const std::string& alternative) {
  return "<img width=\"" + std::to_string(image.width) + "\" height=\"" +
         std::to_string(image.height) + "\" alt=\"" + escaped(alternative) + "\" src=\"" +
         data_uri(image, meaning) + "\">";
}

std::string figure(const std::string& name, const std::string& label, const std::string& content) {
  return "<figure><figcaption><b>" + escaped(label) + "</b> <span class=\"quiet\">" +
         escaped(name) + "</span></figcaption>" + content + "</figure>\n";
}

// A candidate under its reference, which hovering or a click brings to light.
std::string swap(const ReportPicture& picture, const std::string& label,
                 const std::string& reference_label) {
  return "<label class=\"swap\"><input type=\"checkbox\" aria-label=\"Show " +
         escaped(reference_label) + " in place of " + escaped(label) + "\">" +
         img(picture.candidate, picture.meaning, picture.name + ", " + label) +
         "<span class=\"back\" style=\"background-image:url(" +
         data_uri(picture.reference, picture.meaning) + ")\"></span>" +
         "<span class=\"tag candidate\">" + escaped(label) + "</span>" +
         "<span class=\"tag reference\">" + escaped(reference_label) + "</span></label>";
}

std::string pictures(const ReportScene& scene) {
  std::string html =
      "<div class=\"pictures\" style=\"--columns:" + std::to_string(scene.views.size() + 1) +
      "\">\n";
  for (size_t i = 0; i < scene.views.front().pictures.size(); ++i) {
    const ReportPicture& first = scene.views.front().pictures[i];
    html += figure(first.name, scene.reference_label,
                   img(first.reference, first.meaning, first.name + ", " + scene.reference_label));
    for (const ReportView& view : scene.views)
      html +=
          figure(first.name, view.label, swap(view.pictures[i], view.label, scene.reference_label));
    html +=
        "<p class=\"note quiet\">Difference of the linear values &times; 16: black is equal, white "
        "is 16/255 or more. Point at a picture above to see " +
        escaped(scene.reference_label) + " in its place; click to keep it there.</p>\n";
    for (const ReportView& view : scene.views)
      html += figure("difference × 16", view.label,
                     img(view.pictures[i].difference, Meaning::data,
                         "Difference of " + first.name + ", " + view.label));
  }
  return html + "</div>\n";
}

// Numbers that help to find a cause but are no criterion.
std::vector<std::pair<std::string, std::string>> further_numbers(const Comparison& comparison) {
  const ColorAgreement& color = comparison.color;
  std::vector<std::pair<std::string, std::string>> rows = {
      {"edge distance, 99 %", number(comparison.edge_distance_99, "%.3g px")},
      {"edge distance, largest", number(comparison.edge_distance_maximum, "%.3g px")},
      {"edge elements", std::to_string(comparison.edge_elements)},
      {"colour difference, largest", number(color.maximum, "%.3g/255")},
      {"pixels left out at the outline", number(100 * color.outline_share, "%.3g %%")}};
  if (comparison.normal) {
    rows.push_back({"normal difference, 99 %", number(comparison.normal->quantile_99, "%.3g/255")});
    rows.push_back(
        {"normal pixels left out", number(100 * comparison.normal->left_out_share, "%.3g %%")});
  }
  return rows;
}

struct Row {
  std::string name;
  std::string limit;
  std::vector<std::string> cells;  // one for each view
};

// Rows by name in order of appearance; a view that lacks one shows a dash.
Row& row_named(std::vector<Row>& rows, const std::string& name, size_t views) {
  for (Row& row : rows)
    if (row.name == name) return row;
  rows.push_back({name, "", std::vector<std::string>(views, "<td>&ndash;</td>")});
  return rows.back();
}

std::string numbers(const ReportScene& scene) {
  std::vector<Row> rows, more;
  std::string head = "<th scope=\"col\">Number</th><th scope=\"col\">Limit</th>";
  for (size_t i = 0; i < scene.views.size(); ++i) {
    const ReportView& view = scene.views[i];
    head += "<th scope=\"col\">" + escaped(view.label) + "</th>";
    for (const Criterion& criterion : criteria(view.numbers, view.limits)) {
      Row& row = row_named(rows, criterion.name, scene.views.size());
      row.limit = criterion.limit_text();
      row.cells[i] = std::string("<td class=\"") + (criterion.holds ? "holds" : "fails") + "\">" +
                     escaped(criterion.value_text()) + "</td>";
    }
    for (const auto& [name, value] : further_numbers(view.numbers))
      row_named(more, name, scene.views.size()).cells[i] = "<td>" + escaped(value) + "</td>";
  }
  std::string html = "<div class=\"numbers\"><table><thead><tr>" + head + "</tr></thead><tbody>\n";
  const auto add = [&](const Row& row, const char* kind) {
    html += std::string("<tr") + kind + "><th scope=\"row\">" + escaped(row.name) + "</th><td>" +
            escaped(row.limit) + "</td>";
    for (const std::string& cell : row.cells) html += cell;
    html += "</tr>\n";
  };
  for (const Row& row : rows) add(row, "");
  for (const Row& row : more) add(row, " class=\"more\"");
  return html + "</tbody></table></div>\n";
}

std::string badge(bool good, const std::string& text) {
  return std::string("<span class=\"badge ") + (good ? "good" : "bad") + "\">" + escaped(text) +
         "</span>";
}

std::string verdict(const ReportView& view) {
  const size_t failed = failed_criteria(view.numbers, view.limits).size();
  return badge(failed == 0, failed == 0 ? "agrees"
                                        : std::to_string(failed) +
                                              (failed == 1 ? " limit missed" : " limits missed"));
}

std::string section(const ReportScene& scene, size_t index) {
  std::string html = "<section id=\"scene-" + std::to_string(index) +
                     "\"><div class=\"head\"><h2>" + escaped(scene.title) + "</h2>";
  for (const ReportView& view : scene.views)
    html += "<span><span class=\"quiet\">" + escaped(view.label) + "</span> " + verdict(view) +
            "</span>";
  html += "</div>\n";
  if (!scene.description.empty()) html += "<p>" + escaped(scene.description) + "</p>\n";
  html += "<dl>";
  for (const auto& [name, value] : scene.facts)
    html += "<div><dt>" + escaped(name) + "</dt><dd>" + escaped(value) + "</dd></div>";
  html += "</dl>\n" + pictures(scene) + numbers(scene);
  std::string failed;
  for (const ReportView& view : scene.views)
    for (const std::string& sentence : failed_criteria(view.numbers, view.limits))
      failed += "<li>" + escaped(view.label + ": " + sentence) + ".</li>";
  if (!failed.empty()) html += "<ul class=\"failed\">" + failed + "</ul>\n";
  return html + "</section>\n";
}

std::string overview(const std::vector<ReportScene>& scenes) {
  std::string html =
      "<div class=\"overview\"><table><thead><tr><th>Scene</th><th colspan=\"9\">"
      "Verdict</th></tr></thead><tbody>\n";
  for (size_t i = 0; i < scenes.size(); ++i) {
    html += "<tr><th scope=\"row\"><a href=\"#scene-" + std::to_string(i) + "\">" +
            escaped(scenes[i].title) + "</a></th>";
    for (const ReportView& view : scenes[i].views)
      html +=
          "<td><span class=\"quiet\">" + escaped(view.label) + "</span> " + verdict(view) + "</td>";
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

void check_scene(const ReportScene& scene) {
  if (scene.views.empty())
    throw Error("the report's scene '" + scene.title + "' has nothing to show");
  for (const ReportView& view : scene.views)
    if (view.pictures.size() != scene.views.front().pictures.size())
      throw Error("the report's scene '" + scene.title + "' has not the same pictures for '" +
                  view.label + "' and '" + scene.views.front().label + "'");
}

}  // namespace

ReportPicture report_picture(const std::string& name, Image reference, Image candidate,
                             Meaning meaning) {
  Image difference = difference_image(reference, candidate);
  return {name, std::move(reference), std::move(candidate), std::move(difference), meaning};
}

std::string report_page(const std::string& title, const std::vector<ReportScene>& scenes) {
  size_t views = 0, failed = 0;
  for (const ReportScene& scene : scenes) {
    check_scene(scene);
    views += scene.views.size();
    for (const ReportView& view : scene.views) failed += !passes(view.numbers, view.limits);
  }
  std::string html =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
      escaped(title) + "</title>\n<style>" + report_style + "</style></head>\n<body><main>\n<h1>" +
      escaped(title) + "</h1>\n<p>";
  const std::string count = std::to_string(views) + (views == 1 ? " comparison" : " comparisons");
  html += failed == 0 ? badge(true, count + ", all limits hold")
                      : badge(false, std::to_string(failed) + " of " + count + " beyond a limit");
  html += "</p>\n";
  if (scenes.size() > 1) html += overview(scenes);
  for (size_t i = 0; i < scenes.size(); ++i) html += section(scenes[i], i);
  return html + "</main></body></html>\n";
}

void write_report(const std::string& path, const std::string& title,
                  const std::vector<ReportScene>& scenes) {
  write_text(path, report_page(title, scenes));
}

}  // namespace sardf
