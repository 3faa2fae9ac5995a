#include "raytruth/images/image_file.hpp"

#include "raytruth/core/error.hpp"
#include "raytruth/core/memory_limit.hpp"
#include "raytruth/core/npy.hpp"
#include "raytruth/images/png_file.hpp"
#include "raytruth/volume/files/byte_stream.hpp"
#include "raytruth/volume/files/refuse.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

namespace raytruth {

namespace {

constexpr std::int64_t most_pixels = std::int64_t{1} << 28;
constexpr std::size_t most_bytes = std::size_t{1} << 33;

static_assert(std::endian::native == std::endian::little, "files are written as numbers lie in memory");

template <class Number>
void append(std::string& bytes, Number number) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

unsigned char byte_of(double light, Transfer8Bit transfer) {
  const double clamped = std::min(std::max(light, 0.0), 1.0);
  return static_cast<unsigned char>(
      std::floor(255 * (transfer == Transfer8Bit::srgb ? srgb_of(clamped) : clamped) + 0.5));
}

std::string png_file(const Image& image, Transfer8Bit transfer) {
  std::vector<unsigned char> bytes;
  bytes.reserve(3 * image.pixels.size());
  for (const Eigen::Array4d& pixel : image.pixels)
    for (int channel = 0; channel < 3; ++channel) bytes.push_back(byte_of(pixel[channel], transfer));
  return write_png(bytes, image.size, transfer == Transfer8Bit::srgb);
}

std::string pfm_file(const Image& image) {
  std::string file = fmt::format("PF\n{} {}\n-1.0\n", image.size[0], image.size[1]);
  for (std::int64_t row = image.size[1]; row-- > 0;)
    for (std::int64_t column = 0; column < image.size[0]; ++column) {
      const Eigen::Array4d& pixel = image.pixels[static_cast<std::size_t>(row * image.size[0] + column)];
      for (int channel = 0; channel < 3; ++channel) append(file, static_cast<float>(pixel[channel]));
    }
  return file;
}

template <class Number>
std::string npy_file(const Image& image, std::string_view type) {
  std::string file =
      npy_header(type, {static_cast<std::size_t>(image.size[1]), static_cast<std::size_t>(image.size[0]), 4});
  for (const Eigen::Array4d& pixel : image.pixels)
    for (const double number : pixel) append(file, static_cast<Number>(number));
  return file;
}

// --- Reading ---

std::string bytes_of(const std::filesystem::path& file) {
  ByteStream stream(file);
  const std::uint64_t size = stream.most_bytes();
  if (size > most_bytes) refuse(file, fmt::format("{} bytes", size), "at most 2^33 are allowed");
  std::string bytes(size, '\0');
  bytes.resize(stream.read({reinterpret_cast<unsigned char*>(bytes.data()), bytes.size()}));
  return bytes;
}

void check_size(const std::filesystem::path& file, std::int64_t width, std::int64_t height) {
  if (width < 1 || height < 1 || width > largest_image_side || height > largest_image_side ||
      width * height > most_pixels)
    refuse(file, fmt::format("an image of {} x {} pixels", width, height),
           fmt::format("1 to {} along each side and 2^28 in all are allowed", largest_image_side));
  need_memory(static_cast<std::uint64_t>(width * height) * sizeof(Eigen::Array4d),
              fmt::format("an image of {} x {} pixels", width, height), file.string());
}

StoredImage from_png(const std::filesystem::path& file, const std::string& bytes) {
  try {
    const PngPixels png = read_png(bytes, largest_image_side, most_pixels);
    Image image(png.size);
    for (std::size_t i = 0; i < png.channels.size(); ++i)
      image.pixels[i / 4][static_cast<Eigen::Index>(i % 4)] = static_cast<double>(png.channels[i]) / png.largest;
    return {.image = std::move(image),
            .has_opacity = png.has_opacity,
            .is_png = true,
            .is_srgb = png.is_srgb,
            .gamma = png.gamma};
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", file.string(), error.what()));
  }
}

/// The next word of a header of text; advances `at` behind the one white space that ends it.
std::string_view next_word(std::string_view bytes, std::size_t& at) {
  constexpr std::string_view white = " \t\r\n";
  const std::size_t begin = std::min(bytes.find_first_not_of(white, at), bytes.size());
  const std::size_t end = std::min(bytes.find_first_of(white, begin), bytes.size());
  at = std::min(end + 1, bytes.size());
  return bytes.substr(begin, end - begin);
}

template <class Number>
std::optional<Number> number_in(std::string_view word) {
  Number number{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return number;
}

/// An image from numbers that lie in a file: `number(i)` is the i-th, rows in the order of the image.
template <class NumberAt>
StoredImage from_numbers(const std::filesystem::path& file, std::int64_t width, std::int64_t height,
                         std::size_t channels, NumberAt&& number) {
  Image image({width, height});
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    Eigen::Array4d& pixel = image.pixels[i];
    pixel[3] = 1;
    for (std::size_t channel = 0; channel < channels; ++channel) {
      const double value = number(i * channels + channel);
      if (!std::isfinite(value))
        refuse(file,
               fmt::format("{} in pixel [{}, {}]", value, i % static_cast<std::size_t>(width),
                           i / static_cast<std::size_t>(width)),
               "finite numbers are allowed");
      pixel[static_cast<Eigen::Index>(channel)] = value;
    }
    if (channels == 1) pixel[1] = pixel[2] = pixel[0];
  }
  return {.image = std::move(image), .has_opacity = channels == 4};
}

template <class Number>
Number read_number(const char* from, bool is_big_endian) {
  std::array<char, sizeof(Number)> bytes{};
  std::memcpy(bytes.data(), from, sizeof(Number));
  if (is_big_endian) std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<Number>(bytes);
}

void check_bytes(const std::filesystem::path& file, std::size_t found, std::size_t expected) {
  if (found != expected)
    refuse(file, fmt::format("{} bytes of pixels", found), fmt::format("{} are allowed by its header", expected));
}

StoredImage read_pfm(const std::filesystem::path& file, const std::string& bytes) {
  std::size_t at = 0;
  const std::string_view magic = next_word(bytes, at);
  const auto width = number_in<std::int64_t>(next_word(bytes, at));
  const auto height = number_in<std::int64_t>(next_word(bytes, at));
  const auto scale = number_in<double>(next_word(bytes, at));
  if ((magic != "PF" && magic != "Pf") || !width || !height || !scale || !std::isfinite(*scale) || *scale == 0)
    refuse(file, "no header of a PFM image", "PF or Pf, width, height and a scale are allowed");
  check_size(file, *width, *height);
  const std::size_t channels = magic == "PF" ? 3 : 1;
  const auto per_row = static_cast<std::size_t>(*width) * channels;
  check_bytes(file, bytes.size() - at, per_row * static_cast<std::size_t>(*height) * sizeof(float));
  return from_numbers(file, *width, *height, channels, [&](std::size_t i) {
    const std::size_t row = static_cast<std::size_t>(*height) - 1 - i / per_row;
    return double{read_number<float>(bytes.data() + at + (row * per_row + i % per_row) * sizeof(float), *scale > 0)};
  });
}

/// The value of a key in the header, a Python dictionary as NumPy writes it: up to the next comma outside parentheses.
std::string_view npy_value(std::string_view header, std::string_view key) {
  const std::size_t found = header.find(fmt::format("'{}':", key));
  if (found == std::string_view::npos) return {};
  std::size_t begin = header.find_first_not_of(' ', found + key.size() + 3);
  if (begin == std::string_view::npos) return {};
  const std::size_t end = header[begin] == '(' ? header.find(')', begin) : header.find_first_of(",}", begin);
  return end == std::string_view::npos ? std::string_view{} : header.substr(begin, end - begin);
}

}  // namespace

StoredImage image_of_npy(const std::filesystem::path& name, const std::string& bytes) {
  const auto refuse_header = [&](std::string_view found) {
    refuse(name, found,
           "a NumPy array of '<f4' or '<f8', C order, shape (height, width) or with 1, 3 or 4 channels, is allowed");
  };
  constexpr std::size_t preamble = 10;
  if (bytes.size() < preamble || !bytes.starts_with("\x93NUMPY\x01")) refuse_header("no header of version 1");
  const std::size_t data = preamble + read_number<std::uint16_t>(bytes.data() + 8, false);
  if (data > bytes.size()) refuse_header("a header that ends early");
  const std::string_view header = std::string_view(bytes).substr(preamble, data - preamble);
  const std::string_view type = npy_value(header, "descr");
  const bool is_double = type == "'<f8'";
  if (!is_double && type != "'<f4'") refuse_header(fmt::format("type {}", printable(type)));
  if (npy_value(header, "fortran_order") != "False") refuse_header("Fortran order");
  std::string_view shape = npy_value(header, "shape");
  std::vector<std::int64_t> sizes;
  for (shape.remove_prefix(std::min<std::size_t>(1, shape.size())); !shape.empty();) {
    const std::size_t comma = std::min(shape.find(','), shape.size());
    std::string_view word = shape.substr(0, comma);
    shape.remove_prefix(std::min(comma + 1, shape.size()));
    while (word.starts_with(' ')) word.remove_prefix(1);
    if (word.empty()) continue;
    if (const auto size = number_in<std::int64_t>(word))
      sizes.push_back(*size);
    else
      refuse_header("a shape that is no list of whole numbers");
  }
  if (sizes.size() == 2) sizes.push_back(1);
  if (sizes.size() != 3 || (sizes[2] != 1 && sizes[2] != 3 && sizes[2] != 4)) refuse_header("another shape");
  check_size(name, sizes[1], sizes[0]);
  const auto channels = static_cast<std::size_t>(sizes[2]);
  const std::size_t width_of_number = is_double ? sizeof(double) : sizeof(float);
  check_bytes(name, bytes.size() - data, static_cast<std::size_t>(sizes[0] * sizes[1]) * channels * width_of_number);
  return from_numbers(name, sizes[1], sizes[0], channels, [&](std::size_t i) {
    const char* const from = bytes.data() + data + i * width_of_number;
    return is_double ? read_number<double>(from, false) : double{read_number<float>(from, false)};
  });
}

double srgb_of(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

double linear_of(double srgb) { return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4); }

std::string image_file(const Image& image, std::string_view extension, Transfer8Bit transfer, NpyNumbers numbers) {
  if (extension == ".png") return png_file(image, transfer);
  if (extension == ".pfm") return pfm_file(image);
  if (extension == ".npy")
    return numbers == NpyNumbers::binary64 ? npy_file<double>(image, "<f8") : npy_file<float>(image, "<f4");
  throw InputError(fmt::format("an image as {}; .png, .pfm or .npy is allowed",
                               extension.empty() ? "a file without extension" : printable(extension)));
}

std::string number_file(const std::vector<double>& numbers, const std::array<std::int64_t, 2>& size) {
  std::string file = npy_header("<f8", {static_cast<std::size_t>(size[1]), static_cast<std::size_t>(size[0])});
  for (const double number : numbers) append(file, number);
  return file;
}

StoredImage read_image(const std::filesystem::path& file) {
  const std::string extension = file.extension().string();
  const std::string bytes = bytes_of(file);
  if (extension == ".png") return from_png(file, bytes);
  if (extension == ".pfm") return read_pfm(file, bytes);
  if (extension == ".npy") return image_of_npy(file, bytes);
  refuse(file, "no image", "a name that ends in .png, .pfm or .npy is allowed");
}

}  // namespace raytruth
