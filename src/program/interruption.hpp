#pragma once

#include <array>
#include <csignal>
#include <string>

namespace raytruth {

/// While it lives, Ctrl-C ends the program with this line; a later one takes its place until it is gone. Where whoever
/// started the program has Ctrl-C ignored, it stays so.
class InterruptionNotice {
 public:
  explicit InterruptionNotice(const std::string& line);
  ~InterruptionNotice();
  InterruptionNotice(const InterruptionNotice&) = delete;
  InterruptionNotice& operator=(const InterruptionNotice&) = delete;
  InterruptionNotice(InterruptionNotice&&) = delete;
  InterruptionNotice& operator=(InterruptionNotice&&) = delete;

  /// What a handler of signals may read: all of it stands before the handler does.
  struct Line {
    std::array<char, 4096> text{};
    volatile std::sig_atomic_t size = 0;
  };

 private:
  Line line_;
  const Line* previous_line_;
  void (*previous_handler_)(int);
};

}  // namespace raytruth
