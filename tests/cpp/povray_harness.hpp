// POV-Ray as an evaluator of functions, for tests.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "povray_gen/names.hpp"
#include "povray_gen/run.hpp"
#include "sardf/process.hpp"

namespace sardf {

/// A folder of its own for one test; removed with it.
class TestFolder {
 public:
  TestFolder() {
    static int count = 0;
    path_ = std::filesystem::temp_directory_path() /
            ("sardf_povray_" + std::to_string(getpid()) + "_" + std::to_string(++count));
    std::filesystem::create_directories(path_);
  }
  ~TestFolder() { std::filesystem::remove_all(path_); }
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

struct FunctionCall {
  std::string function;
  std::vector<double> arguments;
};

/// The values of function calls as POV-Ray computes them. `declarations`: the functions' text;
/// `prepare` gets the folder to put other files into.
inline std::vector<double> evaluate_in_povray(
    const std::string& declarations, const std::vector<FunctionCall>& calls,
    std::string* messages = nullptr, const std::function<void(const TestFolder&)>& prepare = {}) {
  const TestFolder folder;
  if (prepare) prepare(folder);
  std::ofstream scene(folder / "scene.pov");
  scene << "#version 3.7;\nglobal_settings { assumed_gamma 1.0 }\n"
        << declarations << "#fopen OUT \"values.txt\" write\n";
  for (const FunctionCall& call : calls) {
    scene << "#write(OUT, str(" << call.function << "(";
    for (size_t i = 0; i < call.arguments.size(); ++i) {
      scene << (i ? ", " : "") << povray::number_text(call.arguments[i]);
    }
    scene << "), 0, 17), \"\\n\")\n";
  }
  scene << "#fclose OUT\nbackground { rgb 0 } sphere { 0, 1 }\n";
  scene.close();
  const ProcessResult result = run_process(
      {povray::find_povray(), "+I./scene.pov", "+O./out.png", "+W1", "+H1", "-D", "+WT1", "-A"},
      {.folder = folder / ""});
  if (messages) *messages = result.errors;
  std::vector<double> out;
  std::ifstream values(folder / "values.txt");
  for (std::string line; std::getline(values, line);) out.push_back(std::stod(line));
  if (out.size() != calls.size()) {
    ADD_FAILURE() << "POV-Ray gave " << out.size() << " of " << calls.size()
                  << " values: " << povray::complaint_in(result.errors);
    out.resize(calls.size(), 0);
  }
  return out;
}

}  // namespace sardf
