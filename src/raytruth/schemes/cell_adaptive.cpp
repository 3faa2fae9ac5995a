#include "raytruth/schemes/cell_adaptive.hpp"

#include "raytruth/rules/rules.hpp"
#include "raytruth/signals/piecewise_polynomial.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace raytruth {

std::vector<int> inner_samples(const std::vector<double>& chords, std::int64_t budget) {
  const double mean = std::accumulate(chords.begin(), chords.end(), 0.0) / static_cast<double>(chords.size());
  std::vector<std::pair<double, std::size_t>> gains;  // negative, so that the largest come first and ties in order
  for (std::size_t i = 0; i < chords.size(); ++i) {
    const double chord = chords[i];
    const double of_second = chord * chord * chord * (chord / (24 * mean));
    gains.emplace_back(-(chord * chord * chord - of_second), i);
    gains.emplace_back(-of_second, i);
  }
  const std::int64_t left = std::max<std::int64_t>(budget - static_cast<std::int64_t>(chords.size()) - 1, 0);
  const auto taken = std::min<std::int64_t>(left, static_cast<std::int64_t>(gains.size()));
  std::sort(gains.begin(), gains.end());
  std::vector<int> counts(chords.size());
  for (std::int64_t i = 0; i < taken; ++i) ++counts[gains[static_cast<std::size_t>(i)].second];
  return counts;
}

template <int Degree>
std::int64_t approximate_cells(const Chain<Degree>& signal, std::int64_t budget, Chain<3>& approximation) {
  std::vector<double> chords;
  for (const auto& piece : signal.pieces) chords.push_back(piece.length);
  const std::vector<int> counts = inner_samples(chords, budget);

  approximation.pieces.clear();
  approximation.end = signal.end;
  std::int64_t samples = signal.pieces.empty() ? 0 : 1;
  Rules<double> rules;
  for (std::size_t i = 0; i < signal.pieces.size(); ++i) {
    const auto& [start, length, polynomial] = signal.pieces[i];
    const double front = polynomial.coefficients.front();
    const double back = polynomial.coefficients.back();
    const auto add = [&, start = start](double begin, double width, const Rules<double>::vec4& curve) {
      approximation.pieces.push_back({start + DoubleDouble(begin), width, Rules<double>::cubic(curve)});
    };
    if (counts[i] == 0) {
      add(0, length, rules.order1(front, back));
    } else if (counts[i] == 1) {
      const double middle = polynomial.value(0.5);
      add(0, length / 2, rules.order2_front(front, middle, back, 0.5));
      add(length / 2, length / 2, rules.order2_back(front, middle, back, 0.5));
    } else {
      const double third = length / 3;
      const double second = polynomial.value(1.0 / 3);
      const double before_last = polynomial.value(2.0 / 3);
      add(0, third, rules.order3_front(front, second, before_last, back));
      add(third, third, rules.order3_middle(front, second, before_last, back));
      add(2 * third, third, rules.order3_back(front, second, before_last, back));
    }
    samples += 1 + counts[i];
  }
  return samples;
}

template std::int64_t approximate_cells(const Chain<3>&, std::int64_t, Chain<3>&);
template std::int64_t approximate_cells(const Chain<largest_degree>&, std::int64_t, Chain<3>&);

}  // namespace raytruth
