#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace raytruth {

/// Calls visit(i, e_i e_(i+1) ... e_(i+width-1)) for every i, where the product of neighbours is combine(front, back),
/// associative and without an inverse: Lum 2004, section 4.2 (M. van Herk 1992 has the same for maxima). The elements
/// lie in bins of `width`. A range begins in one bin, to whose end it reaches, and goes on into the next: both parts
/// grow by one element at a time, so that each range takes three products, however wide it is.
template <class Value, class Combine, class Visit>
void for_each_subrange(const std::vector<Value>& elements, std::size_t width, const Combine& combine, Visit&& visit) {
  std::vector<Value> to_bin_end(width);
  for (std::size_t bin = 0; bin + width <= elements.size(); bin += width) {
    to_bin_end.back() = elements[bin + width - 1];
    for (std::size_t r = width - 1; r-- > 0;) to_bin_end[r] = combine(elements[bin + r], to_bin_end[r + 1]);
    visit(bin, to_bin_end.front());

    const std::size_t next_bin = bin + width;
    if (next_bin == elements.size()) return;
    Value from_next_bin = elements[next_bin];
    for (std::size_t r = 1; r < width && next_bin + r <= elements.size(); ++r) {
      if (r > 1) from_next_bin = combine(from_next_bin, elements[next_bin + r - 1]);
      visit(bin + r, combine(to_bin_end[r], from_next_bin));
    }
  }
}

/// A diagonal of a table on one side of i = j: |j - i| = width for all entries on it.
struct Diagonal {
  std::size_t size = 0;  ///< of the table
  std::size_t width = 0;
  bool backwards = false;  ///< i > j: intervals are crossed from the last one down

  /// The entry whose range begins with the `first` interval in the order of crossing.
  [[nodiscard]] std::size_t front(std::size_t first) const { return backwards ? size - 1 - first : first; }
  [[nodiscard]] std::size_t back(std::size_t first) const {
    return backwards ? front(first) - width : front(first) + width;
  }
};

/// Calls visit(diagonal) for all but i = j, each on any thread.
template <class Visit>
void for_each_diagonal(std::size_t size, const Visit& visit) {
  tbb::parallel_for(std::size_t{1}, size, [&](std::size_t width) {
    for (const bool backwards : {false, true}) visit(Diagonal{size, width, backwards});
  });
}

/// The entries of a table of n x n off its diagonal, in O(n^2): along a diagonal |j - i| is constant, so every interval
/// of the transfer function is the same element in all entries there (Lum 2004, section 4.2). For each diagonal
/// make(width, backwards) gives the n - 1 elements in the order in which they are crossed; the products go to
/// write(front, back, value). The same bits on any number of threads.
template <class Make, class Combine, class Write>
void for_each_entry(std::size_t size, const Make& make, const Combine& combine, const Write& write) {
  for_each_diagonal(size, [&](const Diagonal& diagonal) {
    for_each_subrange(
        make(diagonal.width, diagonal.backwards), diagonal.width, combine,
        [&](std::size_t first, const auto& value) { write(diagonal.front(first), diagonal.back(first), value); });
  });
}

/// The elements of homogeneous intervals: element(interval) for each, in the order of crossing.
template <class Interval, class Element>
auto elements_of(const std::vector<Interval>& intervals, bool backwards, const Element& element) {
  std::vector<decltype(element(intervals.front()))> elements;
  elements.reserve(intervals.size());
  for (const Interval& interval : intervals) elements.push_back(element(interval));
  if (backwards) std::reverse(elements.begin(), elements.end());
  return elements;
}

}  // namespace raytruth
