#include "experiments/output.hpp"
#include "program/command.hpp"
#include "raytruth/core/error.hpp"
#include "raytruth/core/one_line.hpp"
#include "raytruth/documents/image_comparison.hpp"
#include "raytruth/images/image_file.hpp"
#include "raytruth/images/registration.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace raytruth {

namespace {

using Json = nlohmann::ordered_json;

struct CompareOptions {
  std::string reference;
  std::string image;
  std::string difference;               ///< file; empty: none
  double gain = 1;                      ///< of the differences in it
  double peak = 1;                      ///< of PSNR and SSIM
  bool registers = false;               ///< compare after flips, moves and scales
  std::optional<std::string> encoding;  ///< of PNG files that do not say which they have
};

/// A file, and what its numbers are compared as.
struct ComparedFile {
  std::string name;
  StoredImage stored;
  std::string encoding;  ///< "linear", "sRGB", "gamma" or, of PNG files that do not say, "not stated"

  [[nodiscard]] const Image& image() const { return stored.image; }
};

constexpr double nearly = 0.01;  // of a gamma that is that of sRGB or 1, in the five digits of the file
constexpr double gamma_of_srgb = 1 / 2.2;

ComparedFile read(const std::string& path, const std::optional<std::string>& encoding) {
  ComparedFile file{
      .name = std::filesystem::path(path).filename().string(), .stored = read_image(path), .encoding = {}};
  const StoredImage& stored = file.stored;
  if (!stored.is_png || (stored.gamma && std::abs(*stored.gamma - 1) < nearly))
    file.encoding = "linear";
  else if (stored.is_srgb || (stored.gamma && std::abs(*stored.gamma / gamma_of_srgb - 1) < nearly))
    file.encoding = "sRGB";
  else if (stored.gamma)
    file.encoding = "gamma";
  else
    file.encoding = encoding ? *encoding == "srgb" ? "sRGB" : *encoding : "not stated";
  return file;
}

/// Whether a PNG's colours, which are not opacity-weighted, are seen through anything.
bool has_translucent_png(const ComparedFile& file) {
  const auto& pixels = file.image().pixels;
  return file.stored.is_png && file.stored.has_opacity &&
         std::any_of(pixels.begin(), pixels.end(), [](const Eigen::Array4d& pixel) { return pixel[3] != 1; });
}

/// Linear light over black.
Image linear_over_black(const ComparedFile& file) {
  Image result = file.image();
  for (Eigen::Array4d& pixel : result.pixels) {
    for (int channel = 0; channel < 3; ++channel) {
      if (file.encoding == "sRGB") pixel[channel] = linear_of(pixel[channel]);
      if (file.encoding == "gamma") pixel[channel] = std::pow(pixel[channel], 1 / *file.stored.gamma);
    }
    if (file.stored.is_png && file.stored.has_opacity) pixel.head<3>() *= pixel[3];
  }
  return result;
}

/// How a file's numbers become light, where they are not it.
std::string decoding(const ComparedFile& file) {
  std::string how;
  if (file.encoding == "sRGB") how = "decoded from sRGB";
  if (file.encoding == "gamma") how = fmt::format("decoded from a gamma of {}", *file.stored.gamma);
  if (has_translucent_png(file)) how += how.empty() ? "composited over black" : " and composited over black";
  return how.empty() ? how : fmt::format("{} is {}", file.name, how);
}

struct Compared {
  Image reference;
  Image image;
  std::string what;
};

Compared compared(const ComparedFile& reference, const ComparedFile& image) {
  const bool is_as_stored = reference.encoding == image.encoding && reference.encoding != "gamma" &&
                            !has_translucent_png(reference) && !has_translucent_png(image);
  if (is_as_stored) {
    const std::string_view of_both = reference.encoding == "linear" ? "linear light over black"
                                     : reference.encoding == "sRGB"
                                         ? "colours over black, encoded as sRGB"
                                         : "colours, encoded in a way that neither file states";
    return {reference.image(), image.image(), fmt::format("values as stored: {}", of_both)};
  }
  std::string what = "linear light over black";
  for (const ComparedFile* const file : {&reference, &image})
    if (const std::string how = decoding(*file); !how.empty()) what += "; " + how;
  return {linear_over_black(reference), linear_over_black(image), std::move(what)};
}

/// Smallest and largest stored colour.
std::array<double, 2> range_of(const Image& image) {
  std::array<double, 2> range{image.pixels.front()[0], image.pixels.front()[0]};
  for (const Eigen::Array4d& pixel : image.pixels) {
    range[0] = std::min(range[0], pixel.head<3>().minCoeff());
    range[1] = std::max(range[1], pixel.head<3>().maxCoeff());
  }
  return range;
}

/// Lit images exceed 1, but not by much; what does looks like whole numbers of 8 or 16 bits.
void warn_of_other_ranges(const ComparedFile& file, double peak, std::vector<std::string>& warnings) {
  constexpr double brightest = 16;
  const double largest = range_of(file.image())[1];
  if (largest <= brightest || peak != 1) return;
  const int of_bits = largest <= 255 ? 255 : 65535;
  warnings.push_back(
      largest <= 65535
          ? fmt::format("{} has values up to {}, which look like 0 to {}, not 0 to 1; PSNR and SSIM have the peak 1 "
                        "(--peak {} for another one)",
                        file.name, largest, of_bits, of_bits)
          : fmt::format("{} has values up to {}; PSNR and SSIM have the peak 1 (--peak for another one)", file.name,
                        largest));
}

/// What a reader of the numbers should know of the files.
std::vector<std::string> warnings_of(const ComparedFile& reference, const ComparedFile& image, double peak) {
  std::vector<std::string> warnings;
  for (const auto& [file, other] : {std::pair{&reference, &image}, {&image, &reference}}) {
    warn_of_other_ranges(*file, peak, warnings);
    if (file->encoding == "not stated" && other->encoding != "not stated")
      warnings.push_back(
          fmt::format("{} does not state how it encodes light: its values are taken for linear light "
                      "(--encoding srgb if they are sRGB, as those of most programs)",
                      file->name));
    if (!file->stored.has_opacity && other->stored.has_opacity)
      warnings.push_back(fmt::format("{} has no opacity: opacities are not compared", file->name));
  }
  return warnings;
}

Json registration_json(const Registration& found, const Image& shared) {
  return {{"averaged_over_blocks", {{"reference", found.reference_block}, {"image", found.image_block}}},
          {"transposed", found.is_transposed},
          {"flipped_left_to_right", found.is_mirrored},
          {"flipped_upside_down", found.is_upside_down},
          {"moved_right", found.moved[0]},
          {"moved_down", found.moved[1]},
          {"colors_times", found.factor},
          {"opacity_times", found.scales_opacity ? found.factor : 1.0},
          {"compared_size", shared.size},
          {"in_words", found == Registration{} ? "nothing: no flip, move, size or factor brings the image far closer"
                                               : found.words()}};
}

[[noreturn]] void refuse_sizes(const ComparedFile& reference, const ComparedFile& image,
                               const std::optional<Registration>& fitting) {
  const auto size = [](const ComparedFile& file) {
    return fmt::format("{} has {} x {} pixels", file.name, file.image().size[0], file.image().size[1]);
  };
  throw InputError(fmt::format("{}, {}; equal sizes are allowed{}", size(reference), size(image),
                               fitting ? fmt::format(", or these with --register ({})", fitting->words())
                                       : ", or with --register whole multiples"));
}

/// |B - A| of each channel, times `gain`.
Image difference_image(const Image& a, const Image& b, double gain) {
  Image difference(a.size);
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    difference.pixels[i] = gain * (b.pixels[i] - a.pixels[i]).abs();
    difference.pixels[i][3] = 1;
  }
  return difference;
}

int compare_images(const CompareOptions& options) {
  const ComparedFile reference = read(options.reference, options.encoding);
  const ComparedFile image = read(options.image, options.encoding);
  const Compared as_is = compared(reference, image);
  const bool have_opacity = reference.stored.has_opacity && image.stored.has_opacity;
  std::vector<std::string> warnings = warnings_of(reference, image, options.peak);

  const std::optional<Registration> found = registration(as_is.image, as_is.reference);
  if (reference.image().size != image.image().size && !(found && options.registers))
    refuse_sizes(reference, image, found);
  const Registration applied = options.registers ? *found : Registration{};
  const Registered both = registered(applied, as_is.image, as_is.reference);

  Json result{
      {"reference", reference.name}, {"image", image.name}, {"size", both.reference.size}, {"compared", as_is.what}};
  if (options.registers) result["registered"] = registration_json(applied, both.reference);
  result.update(image_error_json(both.image, both.reference, have_opacity, options.peak));
  result["range"] = {{"reference", range_of(reference.image())}, {"image", range_of(image.image())}};
  if (!options.registers && *found != Registration{}) {
    const Registered better = registered(*found, as_is.image, as_is.reference);
    const Json errors = image_error_json(better.image, better.reference, have_opacity, options.peak);
    result["hint"] = fmt::format("{} would be far closer {}: rmse {} instead of {}; --register compares so", image.name,
                                 found->words(), errors["rmse"].get<double>(), result["rmse"].get<double>());
  }
  for (const std::string& warning : warnings) say("warning: " + warning);
  if (!warnings.empty()) result["warnings"] = warnings;
  if (!options.difference.empty()) {
    const std::filesystem::path file = options.difference;
    // Differences are no colours, so they are not encoded as such.
    write_whole(file, image_file(difference_image(both.reference, both.image, options.gain), file.extension().string(),
                                 Transfer8Bit::linear));
    result["difference"] = file.filename().string();
    result["gain"] = options.gain;
  }
  print(result.dump(2) + "\n");
  return 0;
}

std::function<int()> describe(CommandOptions& add) {
  const auto options = std::make_shared<CompareOptions>();
  add.operand("reference", options->reference, ".pfm, .npy (linear light over black) or .png");
  add.operand("image", options->image, "An image of the same size");
  add.flag("--register", options->registers,
           "Compare after what brings the image far closer: flips, moves by whole pixels, other sizes, a factor");
  add.word("--encoding", options->encoding, {"srgb", "linear"}, "What PNG files hold that do not state it");
  add.positive_number("--peak", options->peak, "Of PSNR and SSIM (default: 1)");
  add.text("--difference", "FILE", options->difference, "Write the magnitudes of the differences into this image");
  add.positive_number("--gain", options->gain, "Times this (default: 1)");
  return [options] { return compare_images(*options); };
}

}  // namespace

extern const Command compare_command;
const Command compare_command{
    .name = "compare",
    .summary = "Tell how far an image is from a reference",
    .example = "raytruth compare truth.pfm image.pfm",
    .notes =
        "Colours over black are compared as they are stored; `compared` says what that is. A PNG that is sRGB is "
        "decoded\n"
        "where the other file holds linear light, and its colours are multiplied by its opacities. `opacity` has the\n"
        "errors of opacities, `all_channels` those of all four, `clamped` those of what a screen shows: colours "
        "clamped\n"
        "to [0, 1], and how many were. `danskin_hanrahan` is 100 sum |I - R| / sum R, in percent; `ssim` that of Wang\n"
        "et al. 2004, windows of 11 x 11. `hint` tells of a flip, a move, another size or a factor between the files.",
    .describe = describe};

}  // namespace raytruth
