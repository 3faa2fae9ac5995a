#include "raytruth/images/png_file.hpp"

#include "raytruth/core/error.hpp"
#include "raytruth/core/memory_limit.hpp"

#include <fmt/format.h>
#include <png.h>

#include <csetjmp>
#include <cstddef>
#include <cstring>

namespace raytruth {

namespace {

/// What libpng's callbacks get at.
struct Stream {
  std::string bytes = {};
  std::size_t at = 0;
  std::array<char, 160> message{};
};

Stream& stream_of(png_structp png) { return *static_cast<Stream*>(png_get_io_ptr(png)); }

[[noreturn]] void fail(png_structp png, png_const_charp message) {
  auto& kept = static_cast<Stream*>(png_get_error_ptr(png))->message;
  std::strncpy(kept.data(), message, kept.size() - 1);
  png_longjmp(png, 1);
}

void ignore(png_structp /*png*/, png_const_charp /*warning*/) {}

void read_bytes(png_structp png, png_bytep to, std::size_t count) {
  Stream& stream = stream_of(png);
  if (count > stream.bytes.size() - stream.at) png_error(png, "the file ends early");
  std::memcpy(to, stream.bytes.data() + stream.at, count);
  stream.at += count;
}

void write_bytes(png_structp png, png_bytep from, std::size_t count) {
  stream_of(png).bytes.append(reinterpret_cast<const char*>(from), count);
}

void flush(png_structp /*png*/) {}

/// Calls libpng; where it gives up it jumps back to here, over frames of its own and of `work`, which must not hold
/// anything that has a destructor. Throws InputError then.
template <class Work>
void attempt(png_structp png, const Stream& stream, const Work& work) {
  if (setjmp(png_jmpbuf(png)) != 0)
    throw InputError(fmt::format("{}; a whole PNG image is allowed", stream.message.data()));
  work();
}

struct Reader {
  explicit Reader(Stream& stream) : png(png_create_read_struct(PNG_LIBPNG_VER_STRING, &stream, fail, ignore)) {
    png_set_read_fn(png, &stream, read_bytes);
    info = png_create_info_struct(png);
  }
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
  Reader(Reader&&) = delete;
  Reader& operator=(Reader&&) = delete;

  png_structp png;
  png_infop info = nullptr;
};

struct Writer {
  explicit Writer(Stream& stream) : png(png_create_write_struct(PNG_LIBPNG_VER_STRING, &stream, fail, ignore)) {
    png_set_write_fn(png, &stream, write_bytes, flush);
    info = png_create_info_struct(png);
  }
  ~Writer() { png_destroy_write_struct(&png, &info); }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  Writer(Writer&&) = delete;
  Writer& operator=(Writer&&) = delete;

  png_structp png;
  png_infop info = nullptr;
};

}  // namespace

PngPixels read_png(const std::string& bytes, std::int64_t largest_side, std::int64_t most_pixels) {
  Stream stream{.bytes = bytes};
  Reader reader(stream);
  png_struct* const png = reader.png;
  png_info* const info = reader.info;
  bool has_opacity = false;
  bool is_srgb = false;
  double gamma = 0;  // 0: none is declared
  attempt(png, stream, [&] {
    png_set_user_limits(png, static_cast<png_uint_32>(largest_side), static_cast<png_uint_32>(largest_side));
    png_read_info(png, info);
    has_opacity =
        (png_get_color_type(png, info) & PNG_COLOR_MASK_ALPHA) != 0 || png_get_valid(png, info, PNG_INFO_tRNS) != 0;
    int intent = 0;
    is_srgb = png_get_sRGB(png, info, &intent) != 0;
    png_get_gAMA(png, info, &gamma);
    png_set_expand(png);
    png_set_gray_to_rgb(png);
    png_set_add_alpha(png, 0xFFFF, PNG_FILLER_AFTER);
    png_set_interlace_handling(png);
    png_read_update_info(png, info);
  });
  PngPixels result{.size = {png_get_image_width(png, info), png_get_image_height(png, info)},
                   .has_opacity = has_opacity,
                   .is_srgb = is_srgb};
  if (!is_srgb && gamma > 0) result.gamma = gamma;
  if (result.size[0] * result.size[1] > most_pixels)
    throw InputError(
        fmt::format("{} x {} pixels; at most {} are allowed", result.size[0], result.size[1], most_pixels));
  // Four channels of two bytes twice, and as numbers of an image.
  constexpr std::uint64_t bytes_per_pixel = 2 * 4 * 2 + 4 * sizeof(double);
  need_memory(bytes_per_pixel * static_cast<std::uint64_t>(result.size[0] * result.size[1]),
              fmt::format("an image of {} x {} pixels", result.size[0], result.size[1]));
  const std::size_t row_bytes = png_get_rowbytes(png, info);
  const bool is_wide = png_get_bit_depth(png, info) == 16;
  std::vector<unsigned char> pixels(row_bytes * static_cast<std::size_t>(result.size[1]));
  std::vector<png_bytep> rows;
  for (std::size_t row = 0; row < static_cast<std::size_t>(result.size[1]); ++row)
    rows.push_back(pixels.data() + row * row_bytes);
  attempt(png, stream, [&] {
    png_read_image(png, rows.data());
    png_read_end(png, nullptr);
  });
  if (is_wide) {
    result.largest = 0xFFFF;
    for (std::size_t i = 0; i < pixels.size(); i += 2)
      result.channels.push_back(static_cast<std::uint16_t>(pixels[i] << 8 | pixels[i + 1]));
  } else {
    result.channels.assign(pixels.begin(), pixels.end());
  }
  return result;
}

std::string write_png(const std::vector<unsigned char>& pixels, const std::array<std::int64_t, 2>& size, bool is_srgb) {
  Stream stream;
  Writer writer(stream);
  png_struct* const png = writer.png;
  png_info* const info = writer.info;
  attempt(png, stream, [&] {
    png_set_IHDR(png, info, static_cast<png_uint_32>(size[0]), static_cast<png_uint_32>(size[1]), 8, PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (is_srgb)
      png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    else
      png_set_gAMA(png, info, 1);
    png_write_info(png, info);
    for (std::int64_t row = 0; row < size[1]; ++row)
      png_write_row(png, pixels.data() + static_cast<std::size_t>(3 * row * size[0]));
    png_write_end(png, info);
  });
  return stream.bytes;
}

}  // namespace raytruth
