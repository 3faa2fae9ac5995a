#include "experiments/python.hpp"

#include "experiments/output.hpp"
#include "raytruth/core/error.hpp"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <sstream>
#include <system_error>

// POSIX asks programs to declare it themselves.
extern char** environ;  // NOLINT(readability-redundant-declaration)

namespace raytruth {

namespace {

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

/// An unnamed file that holds `text`, to be read from its beginning.
File temporary_file(const std::string& text) {
  File file(std::tmpfile(), std::fclose);
  if (!file || std::fwrite(text.data(), 1, text.size(), file.get()) != text.size() || std::fflush(file.get()) != 0)
    throw OutputError(fmt::format("a temporary file: {}; a TMPDIR that can be written to is allowed",
                                  std::generic_category().message(errno)));
  std::rewind(file.get());
  return file;
}

std::vector<std::string> lines_of(std::FILE* file) {
  std::rewind(file);
  std::vector<std::string> lines;
  std::string text;
  std::array<char, 4096> part{};
  while (const std::size_t count = std::fread(part.data(), 1, part.size(), file)) text.append(part.data(), count);
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);)
    if (!line.empty()) lines.push_back(line);
  return lines;
}

}  // namespace

PythonOutcome run_python(const std::string& script, const std::vector<std::string>& arguments) {
  const char* const chosen = std::getenv("RAYTRUTH_PYTHON");
  const std::string interpreter = chosen != nullptr ? chosen : "/usr/bin/python3";
  const File input = temporary_file(script);
  const File errors = temporary_file("");

  std::vector<std::string> words{interpreter, "-B", "-"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers(words.size() + 1);  // the last one stays null
  std::transform(words.begin(), words.end(), pointers.begin(), [](std::string& word) { return word.data(); });

  posix_spawn_file_actions_t actions{};
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, fileno(input.get()), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, fileno(errors.get()), STDERR_FILENO);
  pid_t child = 0;
  const int failure = posix_spawnp(&child, interpreter.c_str(), &actions, nullptr, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failure != 0)
    throw MissingError(fmt::format("{}: {}; install python3 and python3-matplotlib", interpreter,
                                   std::generic_category().message(failure)));
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), lines_of(errors.get())};
}

}  // namespace raytruth
