// What a user of the library writes: xi of second order along one ray.

#include <iostream>
#include <raytruth/catalogue.hpp>
#include <raytruth/measures/signal_error.hpp>
#include <raytruth/signals/random_field.hpp>
#include <raytruth/signals/trilinear.hpp>

int main() {
  const raytruth::Grid grid = raytruth::random_field(16, 1, 1);
  const raytruth::Chain<3> signal = raytruth::trace_trilinear(grid, {{-1, 3.2, 4.1}, {1, 0.4, 0.3}});
  raytruth::Samples<double> samples;
  raytruth::sample_cells(signal, samples);
  raytruth::Chain<3> approximation;
  raytruth::approximate<raytruth::Order2>(signal, samples, approximation);
  const double error = raytruth::xi(signal, approximation);
  std::cout << "xi " << error << '\n';
  return error > 0 && error < 0.1 ? 0 : 1;
}
