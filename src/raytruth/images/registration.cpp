#include "raytruth/images/registration.hpp"

#include "raytruth/core/error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unsupported/Eigen/FFT>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdlib>
#include <vector>

namespace raytruth {

namespace {

using Size = std::array<std::int64_t, 2>;

constexpr std::int64_t largest_coarse_side = 256;  // moves are looked for in images no larger, then refined
constexpr double far_closer = 0.25;                // of the root mean square error
constexpr double clearly_closer = 0.5;             // each part must make it so
constexpr double indistinct = 1e-6;  // errors below this share of the image's own variation are left alone
constexpr double next_to = 2e-3;     // a round factor

const Eigen::Array4d& pixel_of(const Image& image, std::int64_t column, std::int64_t row) {
  return image.pixels[static_cast<std::size_t>(row * image.size[0] + column)];
}

Image block_means(const Image& image, std::int64_t block) {
  if (block == 1) return image;
  Image result({image.size[0] / block, image.size[1] / block});
  const double share = 1 / static_cast<double>(block * block);
  for (std::int64_t row = 0; row < result.size[1]; ++row)
    for (std::int64_t column = 0; column < result.size[0]; ++column)
      for (std::int64_t y = 0; y < block; ++y)
        for (std::int64_t x = 0; x < block; ++x)
          result.at(column, row) += share * pixel_of(image, column * block + x, row * block + y);
  return result;
}

/// The image transposed, mirrored and upside down, as the registration says.
Image turned(const Registration& how, const Image& image) {
  const Size size = how.is_transposed ? Size{image.size[1], image.size[0]} : image.size;
  Image result(size);
  for (std::int64_t row = 0; row < size[1]; ++row)
    for (std::int64_t column = 0; column < size[0]; ++column) {
      const std::int64_t x = how.is_mirrored ? size[0] - 1 - column : column;
      const std::int64_t y = how.is_upside_down ? size[1] - 1 - row : row;
      result.at(column, row) = how.is_transposed ? pixel_of(image, y, x) : pixel_of(image, x, y);
    }
  return result;
}

/// What two images of equal size share if the one is moved.
struct Overlap {
  Overlap(const Size& size, const Size& moved) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      first[axis] = std::max(moved[axis], std::int64_t{0});
      count[axis] = std::max(size[axis] - std::abs(moved[axis]), std::int64_t{0});
    }
  }
  Size first{};  ///< in the one that stays
  Size count{};
};

/// Sums over what two images share.
struct Products {
  double squares = 0;          ///< of the image's colours
  double products = 0;         ///< of both
  double color_reference = 0;  ///< squares of the reference's colours
  double opacity_squares = 0;  ///< and so of opacities
  double opacity_products = 0;
  double opacity_reference = 0;
  double count = 0;

  Products(const Image& image, const Image& reference, const Size& moved) {
    const Overlap shared(reference.size, moved);
    for (std::int64_t row = shared.first[1]; row < shared.first[1] + shared.count[1]; ++row)
      for (std::int64_t column = shared.first[0]; column < shared.first[0] + shared.count[0]; ++column) {
        const Eigen::Array4d& a = pixel_of(image, column - moved[0], row - moved[1]);
        const Eigen::Array4d& b = pixel_of(reference, column, row);
        squares += a.head<3>().square().sum();
        products += (a.head<3>() * b.head<3>()).sum();
        color_reference += b.head<3>().square().sum();
        opacity_squares += a[3] * a[3];
        opacity_products += a[3] * b[3];
        opacity_reference += b[3] * b[3];
      }
    count = static_cast<double>(shared.count[0] * shared.count[1]);
  }

  [[nodiscard]] double color_error(double factor) const {
    return std::max(0.0, color_reference - 2 * factor * products + factor * factor * squares);
  }
  [[nodiscard]] double opacity_error(double factor) const {
    return std::max(0.0, opacity_reference - 2 * factor * opacity_products + factor * factor * opacity_squares);
  }
  [[nodiscard]] double best_factor() const { return squares > 0 && products > 0 ? products / squares : 1; }
};

double square_error(const Products& sums, const Registration& how) {
  return (sums.color_error(how.factor) + sums.opacity_error(how.scales_opacity ? how.factor : 1)) /
         std::max(1.0, sums.count);
}

/// The factor of least squares, or a round one that is next to it.
double round_factor(double factor) {
  for (const double round : {1.0, 255.0, 65535.0, 256.0, 65536.0, 100.0, 1000.0, 2.0, 4.0, 8.0, 16.0})
    for (const double candidate : {round, 1 / round})
      if (std::abs(factor / candidate - 1) < next_to) return candidate;
  return factor;
}

/// With the factor that brings it clearly closer, if one does.
Registration with_factor(Registration how, const Products& sums) {
  Registration scaled = how;
  scaled.factor = round_factor(sums.best_factor());
  if (scaled.factor == 1) return how;
  scaled.scales_opacity = sums.opacity_error(scaled.factor) < sums.opacity_error(1);
  const double halved = clearly_closer * clearly_closer;
  return square_error(sums, scaled) < halved * square_error(sums, how) ? scaled : how;
}

// --- Correlation ---

/// One number for each pixel: light and opacity less their means.
struct Plane {
  explicit Plane(const Image& image) : size(image.size) {
    double sum = 0;
    for (const Eigen::Array4d& pixel : image.pixels) sum += values.emplace_back(pixel.sum());
    const double mean = sum / static_cast<double>(values.size());
    for (double& value : values) value -= mean;
  }
  Size size;
  std::vector<double> values;
};

using Spectrum = std::vector<std::complex<double>>;

/// Fourier transforms of planes, with as much of nothing around them as keeps their ends apart.
class Transforms {
 public:
  explicit Transforms(const Size& size) {
    for (std::size_t axis = 0; axis < 2; ++axis)
      while (size_[axis] < 2 * size[axis]) size_[axis] *= 2;
  }

  Spectrum operator()(const Plane& plane) {
    Spectrum result(static_cast<std::size_t>(size_[0] * size_[1]));
    for (std::int64_t row = 0; row < plane.size[1]; ++row)
      for (std::int64_t column = 0; column < plane.size[0]; ++column)
        result[static_cast<std::size_t>(row * size_[0] + column)] =
            plane.values[static_cast<std::size_t>(row * plane.size[0] + column)];
    transform(result, false);
    return result;
  }

  /// The largest sum of products of two planes, the second one moved by up to half its size, and the move.
  std::pair<double, Size> largest_correlation(const Spectrum& reference, const Spectrum& image, const Size& size) {
    Spectrum product(reference.size());
    for (std::size_t i = 0; i < product.size(); ++i) product[i] = reference[i] * std::conj(image[i]);
    transform(product, true);
    std::pair<double, Size> best{product[0].real(), {}};
    for (std::int64_t down = -size[1] / 2; down <= size[1] / 2; ++down)
      for (std::int64_t right = -size[0] / 2; right <= size[0] / 2; ++right) {
        const std::int64_t row = (down + size_[1]) % size_[1];
        const std::int64_t column = (right + size_[0]) % size_[0];
        const double here = product[static_cast<std::size_t>(row * size_[0] + column)].real();
        // No move wins against one that is as good but for rounding.
        if (here > best.first + 1e-9 * std::abs(best.first)) best = {here, {right, down}};
      }
    return best;
  }

 private:
  void transform(Spectrum& spectrum, bool is_inverse) {
    std::vector<std::complex<double>> line;
    std::vector<std::complex<double>> transformed;
    const auto along = [&](std::size_t first, std::size_t count, std::size_t stride) {
      line.resize(count);
      for (std::size_t i = 0; i < count; ++i) line[i] = spectrum[first + i * stride];
      if (is_inverse)
        fft_.inv(transformed, line);
      else
        fft_.fwd(transformed, line);
      for (std::size_t i = 0; i < count; ++i) spectrum[first + i * stride] = transformed[i];
    };
    const auto width = static_cast<std::size_t>(size_[0]);
    const auto height = static_cast<std::size_t>(size_[1]);
    for (std::size_t row = 0; row < height; ++row) along(row * width, width, 1);
    for (std::size_t column = 0; column < width; ++column) along(column, height, width);
  }

  Size size_{1, 1};
  Eigen::FFT<double> fft_;
};

/// The flips and the move of the largest correlation; of an image in equal size, transposed already where it must be.
Registration best_geometry(const Registration& start, const Image& image, const Image& reference) {
  std::int64_t block = 1;
  while (std::max(reference.size[0], reference.size[1]) / block > largest_coarse_side) block *= 2;
  const Image coarse = block_means(image, block);
  const Plane coarse_reference(block_means(reference, block));
  Transforms transforms(coarse_reference.size);
  const Spectrum spectrum = transforms(coarse_reference);
  const bool may_transpose = image.size[0] == image.size[1];
  Registration best = start;
  double largest = 0;
  for (const bool transposes : {false, true}) {
    if (transposes && !may_transpose) break;
    for (const bool flips_rows : {false, true})
      for (const bool flips_columns : {false, true}) {
        Registration turn;
        turn.is_transposed = transposes;
        turn.is_mirrored = flips_columns;
        turn.is_upside_down = flips_rows;
        const auto [correlation, moved] =
            transforms.largest_correlation(spectrum, transforms(Plane(turned(turn, coarse))), coarse_reference.size);
        if (!(correlation > largest * (1 + 1e-9))) continue;
        largest = correlation;
        best.is_transposed = start.is_transposed != transposes;
        best.is_mirrored = flips_columns;
        best.is_upside_down = flips_rows;
        best.moved = {moved[0] * block, moved[1] * block};
      }
  }
  // What a coarse pixel hides: in images twice as fine each, the neighbours of what was found.
  Registration turn = best;
  turn.is_transposed = start.is_transposed != best.is_transposed;
  const Image upright = turned(turn, image);
  while (block > 1) {
    block /= 2;
    const Image finer = block_means(upright, block);
    const Image finer_reference = block_means(reference, block);
    const Size around{best.moved[0] / block, best.moved[1] / block};
    double least = INFINITY;
    for (std::int64_t down = -2; down <= 2; ++down)
      for (std::int64_t right = -2; right <= 2; ++right) {
        const Size moved{around[0] + right, around[1] + down};
        const Products sums(finer, finer_reference, moved);
        const double error = sums.color_error(sums.best_factor()) / std::max(1.0, sums.count);
        if (error < least) {
          least = error;
          best.moved = {moved[0] * block, moved[1] * block};
        }
      }
  }
  return best;
}

/// The mean square of an image less its mean, summed over channels.
double variation_of(const Image& image) {
  const auto count = static_cast<double>(image.pixels.size());
  Eigen::Array4d mean = Eigen::Array4d::Zero();
  for (const Eigen::Array4d& pixel : image.pixels) mean += pixel / count;
  double sum = 0;
  for (const Eigen::Array4d& pixel : image.pixels) sum += (pixel - mean).square().sum();
  return sum / count;
}

/// By which blocks both images come to one size, and whether the one must be transposed.
std::optional<Registration> equal_sizes(const Size& image, const Size& reference) {
  for (const bool transposes : {false, true}) {
    const Size size = transposes ? Size{image[1], image[0]} : image;
    Registration result;
    result.is_transposed = transposes;
    if (size[0] % reference[0] == 0 && size[1] % reference[1] == 0 &&
        size[0] / reference[0] == size[1] / reference[1]) {
      result.image_block = size[0] / reference[0];
      return result;
    }
    if (reference[0] % size[0] == 0 && reference[1] % size[1] == 0 &&
        reference[0] / size[0] == reference[1] / size[1]) {
      result.reference_block = reference[0] / size[0];
      return result;
    }
  }
  return std::nullopt;
}

}  // namespace

std::string Registration::words() const {
  std::vector<std::string> done;
  if (image_block > 1) done.push_back(fmt::format("averaged over blocks of {0} x {0} pixels", image_block));
  if (is_transposed) done.emplace_back("transposed");
  if (is_mirrored) done.emplace_back("flipped left to right");
  if (is_upside_down) done.emplace_back("flipped upside down");
  std::vector<std::string> ways;
  if (moved[0] != 0) ways.push_back(fmt::format("{} to the {}", std::abs(moved[0]), moved[0] > 0 ? "right" : "left"));
  if (moved[1] != 0) ways.push_back(fmt::format("{} {}", std::abs(moved[1]), moved[1] > 0 ? "down" : "up"));
  if (!ways.empty()) done.push_back(fmt::format("moved by whole pixels, {}", fmt::join(ways, " and ")));
  if (factor != 1) done.push_back(fmt::format("its {} times {}", scales_opacity ? "values" : "colours", factor));
  if (reference_block > 1)
    done.push_back(fmt::format("the reference averaged over blocks of {0} x {0} pixels", reference_block));
  return fmt::format("{}", fmt::join(done, "; "));
}

std::optional<Registration> registration(const Image& image, const Image& reference) {
  const auto sizes = equal_sizes(image.size, reference.size);
  if (!sizes) return std::nullopt;
  Registration only_transposed;
  only_transposed.is_transposed = sizes->is_transposed;
  const Image resized = turned(only_transposed, block_means(image, sizes->image_block));
  const Image resized_reference = block_means(reference, sizes->reference_block);

  const Products in_place(resized, resized_reference, {});
  const double plain = square_error(in_place, *sizes);
  const double variation = variation_of(resized_reference);
  if (!(plain > indistinct * indistinct * variation)) return sizes;

  Registration best = with_factor(*sizes, in_place);
  double error = square_error(in_place, best);
  Registration geometry = best_geometry(*sizes, resized, resized_reference);
  Registration turn = geometry;
  turn.is_transposed = geometry.is_transposed != sizes->is_transposed;
  const Products elsewhere(turned(turn, resized), resized_reference, geometry.moved);
  geometry = with_factor(geometry, elsewhere);
  const double halved = clearly_closer * clearly_closer;
  if (const double there = square_error(elsewhere, geometry); there < halved * error) {
    best = geometry;
    error = there;
  }
  // A factor near 0 makes any image as close as a black one is, which explains nothing.
  return error < far_closer * far_closer * plain && error < halved * variation ? best : *sizes;
}

Registered registered(const Registration& registration, const Image& image, const Image& reference) {
  const Image upright = turned(registration, block_means(image, registration.image_block));
  const Image resized = block_means(reference, registration.reference_block);
  const Overlap shared(resized.size, registration.moved);
  if (upright.size != resized.size || shared.count[0] == 0 || shared.count[1] == 0)
    throw InputError("images that share no pixel; others are allowed");
  Registered result{.image = Image(shared.count), .reference = Image(shared.count)};
  for (std::int64_t row = 0; row < shared.count[1]; ++row)
    for (std::int64_t column = 0; column < shared.count[0]; ++column) {
      const std::int64_t x = shared.first[0] + column;
      const std::int64_t y = shared.first[1] + row;
      Eigen::Array4d& pixel = result.image.at(column, row);
      pixel = pixel_of(upright, x - registration.moved[0], y - registration.moved[1]);
      pixel.head<3>() *= registration.factor;
      if (registration.scales_opacity) pixel[3] *= registration.factor;
      result.reference.at(column, row) = pixel_of(resized, x, y);
    }
  return result;
}

}  // namespace raytruth
