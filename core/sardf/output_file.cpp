#include "sardf/output_file.hpp"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <filesystem>
#include <system_error>

#include "sardf/error.hpp"

namespace sardf {

namespace fs = std::filesystem;

std::string temporary_name(const std::string& path) {
  static std::atomic<unsigned> count{0};
  const fs::path target(path);
  std::string name(1, '.');
  name += target.filename().string();
  name += '.' + std::to_string(getpid()) + '-' + std::to_string(count++) + ".partial";
  return (target.parent_path() / name).string();
}

OutputFile::OutputFile(std::string path)
    : path_(std::move(path)), temporary_(temporary_name(path_)) {
  if (fs::is_directory(path_)) throw Failure("cannot be written: it is a folder", path_);
  errno = 0;
  stream_.open(temporary_, std::ios::binary);
  if (!stream_) fail(errno);
}

OutputFile::~OutputFile() {
  if (committed_) return;
  stream_.close();
  std::error_code ignored;
  fs::remove(temporary_, ignored);
}

void OutputFile::write(const std::string& bytes) {
  errno = 0;
  stream_.write(bytes.data(), std::streamsize(bytes.size()));
  if (!stream_) fail(errno);
}

void OutputFile::commit() {
  errno = 0;
  stream_.close();
  if (!stream_) fail(errno);
  std::error_code failed;
  fs::rename(temporary_, path_, failed);
  if (failed) fail(failed.value());
  committed_ = true;
}

void OutputFile::fail(int reason) {
  throw Failure("cannot be written: " +
                    (reason ? std::generic_category().message(reason) : "the disk may be full"),
                path_);
}

void write_file(const std::string& path, const std::string& bytes) {
  OutputFile file(path);
  file.write(bytes);
  file.commit();
}

}  // namespace sardf
