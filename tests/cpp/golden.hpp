// Golden values: CSV files whose first line is "# {json}" with parameters and tolerance, then a
// line of column names, then numbers. They come from an implementation that shares no code with
// this one.
//
// tests/golden has the papers' parameters. Its folders varied_1 and varied_2 are two more draws,
// with other seeds and parameters; of files with more than 300 rows they keep every third.
// $SARDF_GOLDEN names another folder to read in place of all three: tests take everything they need
// from the files, and do not count on a number of rows.
#pragma once

#include <gtest/gtest.h>

#include <cctype>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include "source_folder.hpp"

namespace sardf::golden {

inline std::vector<std::string> folders() {
  if (const char* other = std::getenv("SARDF_GOLDEN")) return {other};
  const std::string papers = source_folder() / "tests/golden";
  return {papers, papers + "/varied_1", papers + "/varied_2"};
}

/// A folder as part of a test's name.
inline std::string test_name(const std::string& folder) {
  std::string name = folder.substr(folder.find_last_of('/') + 1);
  for (char& c : name) {
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  }
  return name;
}

struct Table {
  nlohmann::json header;
  std::vector<std::string> names;
  std::vector<std::vector<double>> rows;

  double tolerance() const { return header.at("tolerance_abs"); }
  const nlohmann::json& parameter(const char* name) const { return header.at("params").at(name); }
  /// Place of a column, or -1.
  int find(const std::string& name) const {
    for (size_t i = 0; i < names.size(); ++i) {
      if (names[i] == name) return int(i);
    }
    return -1;
  }
  size_t column(const std::string& name) const {
    const int place = find(name);
    if (place < 0) throw std::runtime_error("no column " + name);
    return size_t(place);
  }
};

inline std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells;
  std::stringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

/// Reads a file of the folder; throws when it is missing or has no rows.
inline Table read(const std::string& folder, const std::string& name) {
  std::ifstream file(folder + "/" + name + ".csv");
  std::string line;
  if (!std::getline(file, line)) throw std::runtime_error("cannot read " + folder + "/" + name);
  Table table;
  table.header = nlohmann::json::parse(line.substr(line.find('{')));
  std::getline(file, line);
  table.names = split(line);
  while (std::getline(file, line)) {
    std::vector<double> row;
    for (const std::string& cell : split(line)) row.push_back(std::strtod(cell.c_str(), nullptr));
    if (row.size() != table.names.size()) throw std::runtime_error("a short row in " + name);
    table.rows.push_back(row);
  }
  if (table.rows.empty()) throw std::runtime_error("no rows in " + name);
  return table;
}

/// A test that runs for each of the folders, in INSTANTIATE_TEST_SUITE_P(Each, ..., each_folder(),
/// folder_name).
class InEachFolder : public testing::TestWithParam<std::string> {
 protected:
  static Table read(const std::string& name) { return golden::read(GetParam(), name); }
};
inline auto each_folder() { return testing::ValuesIn(folders()); }
inline std::string folder_name(const testing::TestParamInfo<std::string>& folder) {
  return test_name(folder.param);
}

/// A test that runs for each of the folders with each of some cases.
template <class Case>
class EachFolderWith : public testing::TestWithParam<std::tuple<std::string, Case>> {
 protected:
  static const Case& this_case() { return std::get<1>(EachFolderWith::GetParam()); }
  static Table read(const std::string& name) {
    return golden::read(std::get<0>(EachFolderWith::GetParam()), name);
  }
};

}  // namespace sardf::golden
