#include "program/progress_bar.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <string>

namespace raytruth {

namespace {

std::string clock_time(double seconds) {
  const auto whole = static_cast<long>(seconds);
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

}  // namespace

ProgressBar::ProgressBar(std::size_t total) : total_(total), is_terminal_(::isatty(STDERR_FILENO) != 0) {}

ProgressBar::~ProgressBar() { clear(); }

void ProgressBar::show(std::string_view part) {
  if (!is_terminal_) return;
  constexpr std::size_t width = 24;
  const std::size_t filled = width * done_ / total_;
  const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const double per_part = timed_ > 0 ? elapsed / static_cast<double>(timed_) : 0;
  const std::string left = timed_ > 0 ? clock_time(per_part * static_cast<double>(total_ - done_)) : "?";
  fmt::print(stderr, "\r\x1b[K[{}{}] {}/{}  {}  {} elapsed, {} left", std::string(filled, '#'),
             std::string(width - filled, '.'), done_, total_, part, clock_time(elapsed), left);
  std::fflush(stderr);
}

void ProgressBar::advance(bool is_counted_in_time) {
  ++done_;
  if (is_counted_in_time) ++timed_;
}

void ProgressBar::clear() const {
  if (is_terminal_) std::fputs("\r\x1b[K", stderr);
}

}  // namespace raytruth
