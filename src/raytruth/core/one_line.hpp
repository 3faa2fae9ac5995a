#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace raytruth {

/// The text as part of a one-line message in UTF-8: line ends and other control characters escaped as in C, bytes that
/// are no UTF-8 as '?'.
std::string one_line(std::string_view text);

/// The text cut to at most `longest` bytes, between characters, and marked with "..." where something is left out.
std::string shortened(std::string_view text, std::size_t longest = 60);

/// The word of `allowed` that is nearest to `found` if it is likely to be meant (a third of its letters and
/// one more may differ), else empty.
template <class Words>
std::string_view closest_word(std::string_view found, const Words& allowed);

/// How many insertions, deletions and replacements of letters turn one word into the other (Levenshtein).
std::size_t edit_distance(std::string_view a, std::string_view b);

template <class Words>
std::string_view closest_word(std::string_view found, const Words& allowed) {
  std::string_view closest;
  std::size_t least = found.size() / 3 + (found.size() < 3 ? 1 : 2);
  for (const std::string_view word : allowed) {
    const std::size_t distance = edit_distance(found, word);
    if (distance >= least) continue;
    least = distance;
    closest = word;
  }
  return closest;
}

}  // namespace raytruth
