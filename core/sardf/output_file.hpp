// A file that appears under its name only when it is complete.
#pragma once

#include <fstream>
#include <string>

namespace sardf {

/// A hidden name in the same folder that no other call in any process gets.
std::string temporary_name(const std::string& path);

/// Writes to a temporary file in the folder of `path`; commit() renames it, and without commit()
/// it is removed. Throws Error that names the path and the reason.
class OutputFile {
 public:
  explicit OutputFile(std::string path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(const std::string& bytes);
  void commit();

 private:
  [[noreturn]] void fail(int reason);

  std::string path_, temporary_;
  std::ofstream stream_;
  bool committed_ = false;
};

/// The whole file at once.
void write_file(const std::string& path, const std::string& bytes);

}  // namespace sardf
