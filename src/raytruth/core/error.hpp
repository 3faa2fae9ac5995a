#pragma once

#include <stdexcept>

namespace raytruth {

/// Bad input. The message is one line: file, place, what was found, what is allowed. The program exits with 2.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Something this machine lacks; the message names the package to install. The program exits with 3.
struct MissingError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace raytruth
