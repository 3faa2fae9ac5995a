#include "raytruth/documents/outside_program.hpp"

#include "raytruth/core/one_line.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>
#include <boost/algorithm/string/trim.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <mutex>
#include <system_error>
#include <utility>

namespace raytruth {

namespace {

using Clock = std::chrono::steady_clock;

constexpr double usual_seconds = 600;
constexpr double most_seconds = 86400;
constexpr std::int64_t usual_megabytes = 64;
constexpr std::int64_t most_megabytes = 4096;
constexpr std::size_t bytes_of_megabyte = 1'000'000;
constexpr std::size_t most_words = 1000;
constexpr std::size_t longest_version = 200;
constexpr std::size_t longest_complaint = 200;
constexpr std::size_t kept_complaints = std::size_t{1} << 16U;
constexpr int something_is_missing = 3;

std::vector<std::string> read_command(const JsonReader& json) {
  std::vector<std::string> words;
  for (const JsonReader& item : json.items()) {
    if (words.size() == most_words) item.refuse("more words", fmt::format("a command of at most {}", most_words));
    words.push_back(item.text());
    if (words.back().find('\0') != std::string::npos) item.refuse_value("a word without zero bytes");
  }
  return words;
}

std::string reason(int error) { return std::generic_category().message(error); }

[[noreturn]] void refuse(std::string_view what, int error = errno) {
  throw OutsideRefusal(fmt::format("{}: {}", what, reason(error)));
}

/// A file descriptor of this process.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    close();
    number_ = std::exchange(other.number_, -1);
    return *this;
  }

  [[nodiscard]] int number() const { return number_; }
  [[nodiscard]] bool is_open() const { return number_ >= 0; }
  void close() {
    if (is_open()) ::close(std::exchange(number_, -1));
  }

 private:
  int number_;
};

struct Pipe {
  Descriptor reading;
  Descriptor writing;
};

Pipe make_pipe() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) refuse("no pipe to it");
  return {Descriptor(ends[0]), Descriptor(ends[1])};
}

/// A file in memory: a program that does not read all of its question blocks nobody, nor does one that reads it twice.
Descriptor file_of(std::string_view text) {
  Descriptor file(::memfd_create("question", MFD_CLOEXEC));
  if (!file.is_open()) refuse("no place for its question");
  while (!text.empty()) {
    const ssize_t written = ::write(file.number(), text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) refuse("no place for its question");
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  ::lseek(file.number(), 0, SEEK_SET);
  return file;
}

/// While it lives, a signal that ends this program ends the group of processes too.
class GroupEnds {
 public:
  explicit GroupEnds(pid_t group) {
    group_ = group;
    struct sigaction action {};
    action.sa_handler = &end;
    sigemptyset(&action.sa_mask);
    for (std::size_t i = 0; i < signals.size(); ++i) ::sigaction(signals[i], &action, &previous_[i]);
  }
  ~GroupEnds() {
    for (std::size_t i = 0; i < signals.size(); ++i) ::sigaction(signals[i], &previous_[i], nullptr);
    ::kill(-group_, SIGKILL);
  }
  GroupEnds(const GroupEnds&) = delete;
  GroupEnds& operator=(const GroupEnds&) = delete;
  GroupEnds(GroupEnds&&) = delete;
  GroupEnds& operator=(GroupEnds&&) = delete;

 private:
  static constexpr std::array signals{SIGINT, SIGTERM, SIGHUP};

  /// Only calls that POSIX allows in a handler; whoever handled the signal before does so behind it.
  static void end(int signal) {
    ::kill(-group_, SIGKILL);
    for (std::size_t i = 0; i < signals.size(); ++i)
      if (signals[i] == signal) ::sigaction(signal, &previous_[i], nullptr);
    ::raise(signal);
  }

  static inline std::atomic<pid_t> group_ = 0;
  static inline std::array<struct sigaction, signals.size()> previous_{};
};

/// What posix_spawn is told, released at the end.
class SpawnPlan {
 public:
  SpawnPlan(const std::filesystem::path& folder, int input, int output, int complaints) {
    posix_spawn_file_actions_init(&actions_);
    posix_spawn_file_actions_adddup2(&actions_, input, STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions_, output, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions_, complaints, STDERR_FILENO);
    if (!folder.empty()) posix_spawn_file_actions_addchdir_np(&actions_, folder.c_str());
    posix_spawnattr_init(&attributes_);
    posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
    posix_spawnattr_setpgroup(&attributes_, 0);
    sigset_t signals;
    sigemptyset(&signals);
    posix_spawnattr_setsigmask(&attributes_, &signals);
    sigaddset(&signals, SIGPIPE);
    posix_spawnattr_setsigdefault(&attributes_, &signals);
  }
  ~SpawnPlan() {
    posix_spawn_file_actions_destroy(&actions_);
    posix_spawnattr_destroy(&attributes_);
  }
  SpawnPlan(const SpawnPlan&) = delete;
  SpawnPlan& operator=(const SpawnPlan&) = delete;
  SpawnPlan(SpawnPlan&&) = delete;
  SpawnPlan& operator=(SpawnPlan&&) = delete;

  /// Starts the command; else the error.
  int start(const std::vector<std::string>& command, pid_t& process) {
    std::vector<std::string> words = command;
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    return ::posix_spawnp(&process, arguments[0], &actions_, &attributes_, arguments.data(), environ);
  }

 private:
  posix_spawn_file_actions_t actions_{};
  posix_spawnattr_t attributes_{};
};

/// One run of a command.
class Run {
 public:
  Run(const OutsideProgram& program, const std::vector<std::string>& command, std::string_view question)
      : program_(program), command_(command), deadline_(Clock::now() + duration(program.seconds)) {
    const Descriptor input = file_of(question);
    Pipe output = make_pipe();
    Pipe complaints = make_pipe();
    SpawnPlan plan(program.folder, input.number(), output.writing.number(), complaints.writing.number());
    if (const int error = plan.start(command, process_); error != 0)
      throw OutsideMissing(
          one_line(fmt::format("{} cannot be started: {}{}", command.front(), reason(error), from_package())));
    output_.from = std::move(output.reading);
    complaints_.from = std::move(complaints.reading);
  }

  /// Its standard output.
  std::string finish() {
    int status = 0;
    {
      const GroupEnds ends(process_);
      try {
        follow();
      } catch (...) {
        ::kill(-process_, SIGKILL);
        wait();
        throw;
      }
      status = wait();
    }
    if (WIFSIGNALED(status))
      throw OutsideRefusal(fmt::format("{} was ended by signal {}{}", name(), WTERMSIG(status), complaint()));
    const int code = WEXITSTATUS(status);
    if (code == something_is_missing)
      throw OutsideMissing(fmt::format("{} lacks something{}{}", name(), complaint(), from_package()));
    if (code != 0) throw OutsideRefusal(fmt::format("{} ended with exit code {}{}", name(), code, complaint()));
    return std::move(output_.text);
  }

 private:
  struct Stream {
    Descriptor from;
    std::string text;
  };

  static Clock::duration duration(double seconds) {
    return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  }

  /// Reads what it says until it has ended. What it started and left behind does not count.
  void follow() {
    // By number: the header of glibc 2.36 declares pidfd_open as a C++ function.
    const Descriptor end(static_cast<int>(::syscall(SYS_pidfd_open, process_, 0)));
    if (!end.is_open()) refuse("nothing tells when it ends");
    for (bool has_ended = false; !has_ended;) {
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline_ - Clock::now()).count();
      if (left <= 0) throw OutsideRefusal(fmt::format("{} took more than {} s", name(), program_.seconds));
      std::array<pollfd, 3> ready{pollfd{output_.from.number(), POLLIN, 0},
                                  pollfd{complaints_.from.number(), POLLIN, 0}, pollfd{end.number(), POLLIN, 0}};
      constexpr std::int64_t longest_wait = 1'000'000;
      if (::poll(ready.data(), ready.size(), static_cast<int>(std::min<std::int64_t>(left, longest_wait))) < 0) {
        if (errno == EINTR) continue;
        refuse("nothing tells what it says");
      }
      has_ended = ready[2].revents != 0;
      if (ready[0].revents != 0) read_some(output_);
      if (ready[1].revents != 0) read_some(complaints_);
    }
    for (Stream* const stream : {&output_, &complaints_})
      while (stream->from.is_open() && has_more(*stream)) read_some(*stream);
  }

  static bool has_more(const Stream& stream) {
    pollfd ready{stream.from.number(), POLLIN, 0};
    return ::poll(&ready, 1, 0) > 0;
  }

  void read_some(Stream& stream) {
    std::array<char, std::size_t{1} << 16U> part{};
    const ssize_t count = ::read(stream.from.number(), part.data(), part.size());
    if (count < 0 && errno == EINTR) return;
    if (count <= 0) return stream.from.close();
    stream.text.append(part.data(), static_cast<std::size_t>(count));
    if (&stream == &complaints_) {
      if (stream.text.size() > 2 * kept_complaints) stream.text.erase(0, stream.text.size() - kept_complaints);
    } else if (stream.text.size() > static_cast<std::size_t>(program_.megabytes) * bytes_of_megabyte) {
      throw OutsideRefusal(fmt::format("{} wrote more than {} MB", name(), program_.megabytes));
    }
  }

  int wait() const {
    int status = 0;
    while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    return status;
  }

  [[nodiscard]] std::string name() const { return one_line(command_.front()); }

  /// ": " and the last line that it complained of.
  [[nodiscard]] std::string complaint() const {
    const std::string text = boost::trim_copy(complaints_.text);
    if (text.empty()) return {};
    const std::size_t before = text.rfind('\n');
    return ": " + shortened(one_line(text.substr(before == std::string::npos ? 0 : before + 1)), longest_complaint);
  }

  [[nodiscard]] std::string from_package() const {
    return program_.package.empty() ? "" : fmt::format("; the package {} has it", one_line(program_.package));
  }

  const OutsideProgram& program_;
  const std::vector<std::string>& command_;
  Clock::time_point deadline_;
  pid_t process_ = 0;
  Stream output_;
  Stream complaints_;
};

}  // namespace

bool is_outside_program(const JsonReader& scheme) { return scheme.is_object(); }

OutsideProgram read_outside_program(const JsonReader& json) {
  json.only({"program", "name", "version", "package", "seconds", "megabytes"});
  OutsideProgram program{.name = json.at("name").text(),
                         .command = read_command(json.at("program")),
                         .version = {},
                         .package = {},
                         .folder = json.resolve(""),
                         .seconds = usual_seconds,
                         .megabytes = usual_megabytes};
  if (const auto version = json.find("version")) program.version = read_command(*version);
  if (const auto package = json.find("package")) program.package = package->text();
  if (const auto seconds = json.find("seconds")) {
    program.seconds = seconds->positive_number();
    seconds->number(0, most_seconds);
  }
  if (const auto megabytes = json.find("megabytes")) program.megabytes = megabytes->integer(1, most_megabytes);
  return program;
}

OutsideAnswer ask(const OutsideProgram& program, std::string_view question) {
  static std::mutex one_at_a_time;
  const std::lock_guard only(one_at_a_time);
  OutsideAnswer answer;
  if (!program.version.empty()) {
    const std::string text = boost::trim_copy(Run(program, program.version, {}).finish());
    answer.version = shortened(one_line(text.substr(0, text.find('\n'))), longest_version);
  }
  answer.bytes = Run(program, program.command, question).finish();
  return answer;
}

TemporaryFolder::TemporaryFolder() {
  std::error_code error;
  std::string pattern = (std::filesystem::temp_directory_path(error) / "raytruth-XXXXXX").string();
  if (error || ::mkdtemp(pattern.data()) == nullptr)
    refuse("no folder for what it reads", error ? error.value() : errno);
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace raytruth
