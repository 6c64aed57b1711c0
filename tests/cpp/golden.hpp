// Golden values: CSV files whose first line is "# {json}" with parameters and tolerance, then a
// line of column names, then numbers. They come from an implementation that shares no code with
// this one.
//
// $SARDF_GOLDEN names another folder of such files (another seed, other parameters); tests take
// everything they need from the files.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

namespace sardf::golden {

inline std::string folder() {
  const char* other = std::getenv("SARDF_GOLDEN");
  return other ? other : std::string(SARDF_SOURCE_DIR) + "/tests/golden";
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
inline Table read(const std::string& name) {
  std::ifstream file(folder() + "/" + name + ".csv");
  std::string line;
  if (!std::getline(file, line)) throw std::runtime_error("cannot read " + folder() + "/" + name);
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

}  // namespace sardf::golden
