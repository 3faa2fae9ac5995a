#pragma once

#include <chrono>
#include <cstddef>
#include <string_view>

namespace raytruth {

/// A bar on standard error, if that is a terminal: what is done, what is being done, the time it took and will take.
class ProgressBar {
 public:
  explicit ProgressBar(std::size_t total);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  ProgressBar(ProgressBar&&) = delete;
  ProgressBar& operator=(ProgressBar&&) = delete;

  /// The next part begins.
  void show(std::string_view part);
  /// It is done. Parts that an earlier run finished say nothing about the time that is left.
  void advance(bool is_counted_in_time = true);
  /// Clears the line, so that something else can be written.
  void clear() const;

 private:
  std::size_t total_;
  std::size_t done_ = 0;
  std::size_t timed_ = 0;
  bool is_terminal_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace raytruth
