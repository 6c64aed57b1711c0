#include "cli/write_text.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include "sardf/error.hpp"

namespace sardf {

namespace {

bool write_all(std::FILE* file, const std::string& text) {
  return std::fwrite(text.data(), 1, text.size(), file) == text.size() && std::fflush(file) == 0;
}

[[noreturn]] void fail(const std::string& path, int reason) {
  throw Error("cannot be written: " + std::generic_category().message(reason), path);
}

}  // namespace

void write_text(const std::string& path, const std::string& text) {
  if (path == "-") {
    if (!write_all(stdout, text)) fail("standard output", errno);
    return;
  }
  namespace fs = std::filesystem;
  const fs::path target(path);
  const fs::path temporary = target.parent_path() / ("." + target.filename().string() + "." +
                                                     std::to_string(getpid()) + ".partial");
  std::FILE* file = std::fopen(temporary.c_str(), "wb");
  if (!file) fail(path, errno);
  int reason = write_all(file, text) ? 0 : errno;
  if (std::fclose(file) != 0 && reason == 0) reason = errno;
  if (reason == 0) {
    std::error_code renamed;
    fs::rename(temporary, target, renamed);
    reason = renamed.value();
  }
  if (reason == 0) return;
  std::error_code ignored;
  fs::remove(temporary, ignored);
  fail(path, reason);
}

}  // namespace sardf
