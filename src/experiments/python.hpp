#pragma once

#include <string>
#include <vector>

namespace raytruth {

/// What a Python script left behind.
struct PythonOutcome {
  int status = 0;                   ///< exit code, or 128 + the signal that ended it
  std::vector<std::string> errors;  ///< lines that it wrote to standard error

  [[nodiscard]] std::string last_error() const { return errors.empty() ? std::string() : errors.back(); }
};

/// Runs a script, which Python reads from standard input, with arguments. The interpreter is that of the environment
/// variable RAYTRUTH_PYTHON, else /usr/bin/python3, to which Debian's matplotlib belongs.
/// Throws MissingError where there is no interpreter.
PythonOutcome run_python(const std::string& script, const std::vector<std::string>& arguments);

}  // namespace raytruth
