#include "sardf/process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>
#if defined(__linux__)
#include <sys/prctl.h>
#endif

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <sstream>

#include "sardf/error.hpp"

namespace sardf {

namespace {

using Clock = std::chrono::steady_clock;
constexpr int poll_milliseconds = 50;

// A file descriptor that closes itself, here and when a program is started.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { close(); }
  void set(int number) { number_ = number; }
  int get() const { return number_; }
  bool is_open() const { return number_ >= 0; }
  void close() {
    if (number_ >= 0) ::close(number_);
    number_ = -1;
  }

 private:
  int number_ = -1;
};

// Both ends close when a program is started; on Linux also when another thread starts one at this
// very moment, which would hold them open for as long as it runs.
bool open_pipe(int* ends) {
#if defined(__linux__)
  return ::pipe2(ends, O_CLOEXEC) == 0;
#else
  if (::pipe(ends) != 0) return false;
  for (int i = 0; i < 2; ++i) ::fcntl(ends[i], F_SETFD, FD_CLOEXEC);
  return true;
#endif
}

struct Pipe {
  Pipe() {
    int ends[2];
    if (!open_pipe(ends)) throw Failure(std::string("no pipe: ") + std::strerror(errno));
    read.set(ends[0]);
    write.set(ends[1]);
  }
  Descriptor read, write;
};

// Between fork and exec only async-signal-safe functions are allowed.
[[noreturn]] void become(char* const* arguments, const char* path, const char* folder, int input,
                         int output, int errors, int failure) {
#if defined(__linux__)
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  ::signal(SIGPIPE, SIG_DFL);
  const bool ready = ::dup2(input, 0) >= 0 && ::dup2(output, 1) >= 0 && ::dup2(errors, 2) >= 0 &&
                     (*folder == 0 || ::chdir(folder) == 0);
  if (ready) ::execv(path, arguments);
  const int reason = errno;
  [[maybe_unused]] const ssize_t written = ::write(failure, &reason, sizeof reason);
  ::_exit(127);
}

// Appends what can be read now; closes at the end of the stream.
void read_available(Descriptor& from, std::string& to) {
  std::array<char, 65536> buffer;
  const ssize_t count = ::read(from.get(), buffer.data(), buffer.size());
  if (count > 0) {
    to.append(buffer.data(), size_t(count));
  } else if (count == 0 || (errno != EINTR && errno != EAGAIN)) {
    from.close();
  }
}

class Child {
 public:
  Child(const std::vector<std::string>& arguments, const ProcessOptions& options) {
    const std::string path = find_program(arguments[0]);
    std::vector<char*> pointers;
    for (const std::string& argument : arguments) {
      pointers.push_back(const_cast<char*>(argument.c_str()));
    }
    pointers.push_back(nullptr);
    const Descriptor nothing(::open("/dev/null", O_RDONLY | O_CLOEXEC));
    Pipe failure;
    id_ = ::fork();
    if (id_ == 0) {
      become(pointers.data(), path.empty() ? pointers[0] : path.c_str(), options.folder.c_str(),
             nothing.get(), output_.write.get(), errors_.write.get(), failure.write.get());
    }
    for (Pipe* pipe : {&output_, &errors_, &failure}) pipe->write.close();
    int reason = id_ < 0 ? errno : 0;
    if (id_ > 0 && ::read(failure.read.get(), &reason, sizeof reason) == ssize_t(sizeof reason)) {
      wait(0);
    }
    if (reason != 0) {
      throw Failure(arguments[0] + " cannot be started" +
                    (options.folder.empty() ? "" : " in " + options.folder) + ": " +
                    std::strerror(reason));
    }
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    kill();
    if (!ended_) wait(0);
  }

  void kill() {
    if (!ended_) ::kill(id_, SIGKILL);
  }

  // Takes what it has written within the next moment; false once it has ended and all is read.
  bool step(ProcessResult& result) {
    const bool was_running = !ended_;
    std::array<pollfd, 2> waiting{
        {{output_.read.get(), POLLIN, 0}, {errors_.read.get(), POLLIN, 0}}};
    const bool open = output_.read.is_open() || errors_.read.is_open();
    const int ready = ::poll(waiting.data(), waiting.size(), was_running ? poll_milliseconds : 0);
    if (ready > 0 && waiting[0].revents) read_available(output_.read, result.output);
    if (ready > 0 && waiting[1].revents) read_available(errors_.read, result.errors);
    if (was_running) wait(WNOHANG);
    if (ended_) result.exit_code = exit_code_;
    // A grandchild may hold the streams open for ever: what is there when the child ends counts.
    return was_running || (open && ready > 0);
  }

 private:
  void wait(int flags) {
    int status = 0;
    if (::waitpid(id_, &status, flags) != id_) return;
    ended_ = true;
    exit_code_ = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  }

  Pipe output_, errors_;
  pid_t id_ = -1;
  bool ended_ = false;
  int exit_code_ = 0;
};

}  // namespace

ProcessResult run_process(const std::vector<std::string>& arguments,
                          const ProcessOptions& options) {
  const auto start = Clock::now();
  Child child(arguments, options);
  ProcessResult result;
  while (child.step(result)) {
    if (options.progress && !options.progress(options.share ? options.share(result.errors) : 0)) {
      child.kill();
      throw Cancelled();
    }
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    if (options.timeout > 0 && seconds > options.timeout && !result.timed_out) {
      result.timed_out = true;
      child.kill();
    }
  }
  return result;
}

std::string find_program(const std::string& name, const std::string& variable) {
  const char* stated = variable.empty() ? nullptr : std::getenv(variable.c_str());
  if (stated && *stated) return stated;
  if (name.find('/') != std::string::npos) return name;
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "/usr/local/bin:/usr/bin:/bin");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::string candidate = (folder.empty() ? "." : folder) + "/" + name;
    if (::access(candidate.c_str(), X_OK) == 0) return candidate;
  }
  return "";
}

}  // namespace sardf
