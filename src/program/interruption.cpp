#include "program/interruption.hpp"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>

namespace raytruth {

namespace {

std::atomic<const InterruptionNotice::Line*> line_to_tell = nullptr;
static_assert(std::atomic<const InterruptionNotice::Line*>::is_always_lock_free);

/// Only calls that POSIX allows in a handler; who started the program learns that the signal ended it.
void tell(int signal) {
  const InterruptionNotice::Line* const line = line_to_tell;
  if (line != nullptr) {
    [[maybe_unused]] const auto written =
        ::write(STDERR_FILENO, line->text.data(), static_cast<std::size_t>(line->size));
  }
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

}  // namespace

InterruptionNotice::InterruptionNotice(const std::string& line) : previous_line_(line_to_tell) {
  const std::size_t size = std::min(line.size(), line_.text.size());
  std::copy_n(line.begin(), size, line_.text.begin());
  line_.size = static_cast<std::sig_atomic_t>(size);
  line_to_tell = &line_;
  previous_handler_ = std::signal(SIGINT, &tell);
  if (previous_handler_ == SIG_IGN) std::signal(SIGINT, SIG_IGN);
}

InterruptionNotice::~InterruptionNotice() {
  std::signal(SIGINT, previous_handler_);
  line_to_tell = previous_line_;
}

}  // namespace raytruth
