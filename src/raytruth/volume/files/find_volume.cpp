#include "raytruth/volume/files/find_volume.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <system_error>

#include "raytruth/volume/files/refuse.hpp"
#include "raytruth/volume/files/stored_volume.hpp"

namespace raytruth {
namespace {

constexpr std::string_view folder_of_mricron_data = "/usr/share/mricron/templates";

void append(std::vector<std::filesystem::path>& folders, std::string_view separated) {
  while (!separated.empty()) {
    const auto end = std::min(separated.find(':'), separated.size());
    if (end > 0) folders.emplace_back(separated.substr(0, end));
    separated.remove_prefix(std::min(end + 1, separated.size()));
  }
}

bool is_there(const std::filesystem::path& file) {
  std::error_code error;
  return std::filesystem::exists(file, error);
}

}  // namespace

std::vector<std::filesystem::path> volume_folders(std::string_view data_option) {
  std::vector<std::filesystem::path> folders;
  append(folders, data_option);
  if (const char* const environment = std::getenv("RAYTRUTH_DATA")) append(folders, environment);
  folders.emplace_back(folder_of_mricron_data);
  return folders;
}

std::filesystem::path find_volume(const std::string& name, const std::vector<std::filesystem::path>& folders) {
  const bool has_extension = std::any_of(volume_formats().begin(), volume_formats().end(),
                                         [&](const VolumeFormat& format) { return name.ends_with(format.extension); });
  if ((has_extension || name.find('/') != std::string::npos) && is_there(name)) return name;
  std::vector<std::string> file_names;
  if (has_extension) {
    file_names.push_back(name);
  } else {
    for (const VolumeFormat& format : volume_formats()) file_names.push_back(name + std::string(format.extension));
  }
  for (const auto& folder : folders) {
    for (const auto& file_name : file_names) {
      if (is_there(folder / file_name)) return folder / file_name;
    }
  }
  throw VolumeAbsent(fmt::format("{}: no such volume in the data folders; name its folder with --data or RAYTRUTH_DATA",
                                 printable(name)));
}

}  // namespace raytruth
