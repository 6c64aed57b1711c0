#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <mutex>
#include <nlohmann/json.hpp>

#include "cli/commands.hpp"
#include "cli/compare_json.hpp"
#include "cli/compare_report.hpp"
#include "cli/picture_size.hpp"
#include "cli/render_blender.hpp"
#include "cli/render_povray.hpp"
#include "cli/work_queue.hpp"
#include "cli/write_text.hpp"
#include "povray_gen/run.hpp"
#include "sardf/camera_file.hpp"
#include "sardf/compare_images.hpp"
#include "sardf/error.hpp"
#include "sardf/scene_file.hpp"

namespace sardf {

namespace {

namespace fs = std::filesystem;

struct Options {
  std::vector<std::string> scenes, blenders, lattices;
  std::string output, size = "640x480", headless = find_headless();
  std::string reference, reference_camera;
  int resolution = 128, texture_size = 2048, samples = 32;
  bool shaded = false;
};

// One scene with the folder of its pictures.
struct Item {
  std::string name, path;
  fs::path folder;
  std::unique_ptr<Scene> scene, reference;
  Camera camera;
};

Item make_item(const Options& options, const std::string& path, const PictureSize& size) {
  Item item;
  item.path = path;
  item.name = fs::path(path).stem();
  item.folder = fs::path(options.output) / item.name;
  item.scene = std::make_unique<Scene>(read_scene(path));
  if (!options.reference.empty()) {
    item.reference = std::make_unique<Scene>(read_scene(options.reference));
  }
  item.camera = scene_camera(*item.scene, size.width, size.height);
  fs::create_directories(item.folder);
  write_text(item.folder / "camera.json", camera_text(item.camera));
  return item;
}

// Prints what was done and how long it took, one line at a time.
class Log {
 public:
  template <class Work>
  void timed(const std::string& what, Work work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    const std::scoped_lock lock(guard_);
    std::printf("%7.1f s  %s\n", taken.count(), what.c_str());
    std::fflush(stdout);
  }

 private:
  std::mutex guard_;
};

std::vector<std::function<void()>> jobs_of(const Options& options, const PictureSize& size,
                                           const std::vector<Item>& items,
                                           const std::vector<Blender>& blenders, Log& log) {
  std::vector<std::function<void()>> jobs;
  const Progress watch = terminal_progress("");
  for (const Item& item : items) {
    const Scene& reference = item.reference ? *item.reference : *item.scene;
    const Camera camera =
        options.reference_camera.empty() ? item.camera : read_camera(options.reference_camera);
    for (const std::string look : {"flat", "normals"}) {
      jobs.push_back([&item, &reference, camera, look, size, watch, &log] {
        povray::SceneFiles files{item.folder / ("povray_" + look + ".pov"), look, camera,
                                 size.width, size.height};
        log.timed(item.name + ": POV-Ray, " + look, [&] {
          // Several jobs run at once: none shows how far it is.
          povray::write_files(reference, files, [&](double) { return watch(0); });
          render_povray(files, item.folder / ("povray_" + look + ".exr"), watch);
        });
      });
    }
    for (const Blender& blender : blenders) {
      // One shaded picture of each scene is enough to look at.
      const bool shaded = options.shaded && &blender == &blenders.front();
      jobs.push_back([&options, &item, &blender, shaded, size, watch, &log] {
        BlenderJob job{item.path, item.folder / blender.label, item.folder / "camera.json"};
        job.looks = shaded ? "flat,normals,shaded" : "flat,normals";
        job.width = size.width;
        job.height = size.height;
        job.resolution = options.resolution;
        job.texture_size = options.texture_size;
        job.samples = options.samples;
        log.timed(item.name + ": " + blender.label,
                  [&] { render_in_blender(blender, job, watch); });
      });
    }
  }
  return jobs;
}

ReportView compare_view(const Item& item, const Blender& blender, const Limits& limits) {
  Image reference = read_image(item.folder / "povray_flat.exr", Meaning::color);
  Image reference_normal = read_image(item.folder / "povray_normals.exr", Meaning::data);
  Image candidate = read_image(item.folder / blender.label / "flat.exr", Meaning::color);
  Image candidate_normal = read_image(item.folder / blender.label / "normals.exr", Meaning::data);
  const Mask reference_mask = mask_from_alpha(reference);
  const Mask candidate_mask = mask_from_alpha(candidate);
  // The same as PNG, for eyes.
  write_image(item.folder / "povray_flat.png", reference, Meaning::color, Depth::byte8);
  write_image(item.folder / (blender.label + " flat.png"), candidate, Meaning::color, Depth::byte8);
  ReportView view;
  view.label = blender.label;
  view.limits = limits;
  view.numbers = compare_images({reference, reference_mask, &reference_normal},
                                {candidate, candidate_mask, &candidate_normal});
  view.pictures.push_back(
      report_picture("Colour", std::move(reference), std::move(candidate), Meaning::color));
  view.pictures.push_back(report_picture("Normal", std::move(reference_normal),
                                         std::move(candidate_normal), Meaning::data));
  return view;
}

// The report, its numbers, and whether everything agrees.
bool report(const Options& options, const std::vector<Item>& items,
            const std::vector<Blender>& blenders) {
  std::vector<ReportScene> scenes;
  nlohmann::ordered_json numbers;
  bool agrees = true;
  for (const Item& item : items) {
    const auto& lattices = options.lattices;
    const bool lattice = std::find(lattices.begin(), lattices.end(), item.name) != lattices.end();
    const Limits limits = lattice ? Limits::lattice() : Limits{};
    ReportScene scene;
    scene.title =
        item.scene->description().title.empty() ? item.name : item.scene->description().title;
    scene.facts = {{"Size", options.size},
                   {"Mesh", std::to_string(options.resolution)},
                   {"Texture", std::to_string(options.texture_size) + "²"}};
    for (const Blender& blender : blenders) {
      scene.views.push_back(compare_view(item, blender, limits));
      const ReportView& view = scene.views.back();
      numbers[item.name][blender.label] = to_json(view.numbers, limits);
      for (const std::string& sentence : failed_criteria(view.numbers, limits)) {
        std::cerr << item.name << ", " << blender.label << ": " << sentence << ".\n";
        agrees = false;
      }
    }
    scenes.push_back(std::move(scene));
  }
  const fs::path folder(options.output);
  write_text(folder / "numbers.json", numbers.dump(2) + "\n");
  write_report(folder / "report.html", "Blender against POV-Ray", scenes);
  std::cout << (folder / "report.html").string() << "\n";
  return agrees;
}

void compare(Options options) {
  const PictureSize size = parse_size(options.size);
  povray::find_povray();
  std::vector<Blender> blenders;
  for (const std::string& program : options.blenders) {
    blenders.push_back(find_blender(program, options.headless));
  }
  std::vector<Item> items;
  for (const std::string& path : options.scenes) {
    items.push_back(make_item(options, path, size));
    for (size_t i = 0; i + 1 < items.size(); ++i) {
      if (items[i].name != items.back().name) continue;
      throw Error("two scenes are called " + items[i].name + ": their pictures would be one file");
    }
  }
  Log log;
  run_jobs(jobs_of(options, size, items, blenders, log), 2);
  if (!report(options, items, blenders)) throw CLI::RuntimeError(1);
}

}  // namespace

void add_compare(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "compare", "Render in Blender and in POV-Ray with one camera, and compare the pictures");
  const auto options = std::make_shared<Options>();
  options->blenders = {"blender"};
  command->add_option("scenes", options->scenes, "Scene files")->required();
  command->add_option("-o,--output", options->output, "Folder for pictures and report.html")
      ->required();
  command->add_option("--size", options->size, "WIDTHxHEIGHT")->capture_default_str();
  command
      ->add_option("--blender", options->blenders,
                   "A Blender, or a Python with bpy; may be given several times")
      ->capture_default_str();
  command->add_option("--headless", options->headless, "The add-on's headless.py")
      ->capture_default_str();
  command->add_option("--resolution", options->resolution, "Cells along the longest side")
      ->capture_default_str();
  command->add_option("--texture", options->texture_size, "Texels along each side")
      ->capture_default_str();
  command->add_option("--lattice", options->lattices,
                      "Names of scenes whose outline counts as a lattice's");
  command->add_flag("--shaded", options->shaded, "Also a lit picture of each scene");
  command->add_option("--samples", options->samples, "Samples of each pixel of the lit picture")
      ->capture_default_str();
  command->add_option("--reference", options->reference,
                      "Render POV-Ray's pictures from this scene instead, to see them differ");
  command->add_option("--reference-camera", options->reference_camera,
                      "Render POV-Ray's pictures with this camera.json instead");
  command->callback([options] { compare(*options); });
}

}  // namespace sardf
