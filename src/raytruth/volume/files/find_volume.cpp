#include "raytruth/volume/files/find_volume.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <boost/algorithm/string/case_conv.hpp>
#include <boost/algorithm/string/predicate.hpp>

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <map>
#include <set>
#include <system_error>

#include "raytruth/core/one_line.hpp"
#include "raytruth/volume/files/refuse.hpp"
#include "raytruth/volume/files/stored_volume.hpp"

namespace raytruth {
namespace {

constexpr std::string_view folder_of_mricron_data = "/usr/share/mricron/templates";

bool is_there(const std::filesystem::path& file) {
  std::error_code error;
  return std::filesystem::exists(file, error);
}

/// The names of files that a volume of this name may have, in the order in which they are tried.
std::vector<std::string> file_names_of(const std::string& name) {
  std::vector<std::string> file_names;
  for (const VolumeFormat& format : volume_formats()) file_names.push_back(name + std::string(format.extension));
  for (const VolumeFormat& format : volume_formats()) {
    file_names.push_back(name + boost::algorithm::to_upper_copy(std::string(format.extension)));
  }
  return file_names;
}

/// The names of volumes that contain `name`, or else the one that is spelt nearly so, and folders that are not there.
std::string hint(const std::string& name, const std::vector<std::filesystem::path>& folders) {
  constexpr std::size_t most = 5;
  std::vector<std::string> names;
  for (const auto& volume : volumes_in(folders)) names.push_back(volume.name);
  const auto* const format = format_of_name(name);
  const auto asked =
      std::filesystem::path(name.substr(0, name.size() - (format ? format->extension.size() : 0))).filename().string();
  std::vector<std::string> alike;
  for (const auto& known : names) {
    if (!asked.empty() && boost::algorithm::icontains(known, asked) && alike.size() < most) alike.push_back(known);
  }
  const auto closest = closest_word(asked, names);
  if (alike.empty() && !closest.empty()) alike.emplace_back(closest);
  std::string text;
  if (!alike.empty()) text = fmt::format("perhaps {}", fmt::join(alike, " or "));
  if (!names.empty()) text += fmt::format("{}`raytruth list volumes` names all", text.empty() ? "" : "; ");
  for (const auto& folder : absent_folders(folders)) {
    if (folder == folder_of_mricron_data) continue;
    text += fmt::format("{}{} is no folder", text.empty() ? "" : "; ", folder.string());
  }
  return text;
}

}  // namespace

std::vector<std::filesystem::path> folders_in(std::string_view separated) {
  std::vector<std::filesystem::path> folders;
  while (!separated.empty()) {
    const auto end = std::min(separated.find(':'), separated.size());
    if (end > 0) folders.emplace_back(separated.substr(0, end));
    separated.remove_prefix(std::min(end + 1, separated.size()));
  }
  return folders;
}

std::vector<std::filesystem::path> folders_of_environment() {
  const char* const folders = std::getenv("RAYTRUTH_DATA");
  return folders_in(folders != nullptr ? folders : "");
}

std::vector<std::filesystem::path> volume_folders(std::string_view data_option) {
  auto folders = folders_in(data_option);
  const auto of_environment = folders_of_environment();
  folders.insert(folders.end(), of_environment.begin(), of_environment.end());
  folders.emplace_back(folder_of_mricron_data);
  return folders;
}

std::filesystem::path find_volume(const std::string& name, const std::vector<std::filesystem::path>& folders) {
  const bool has_extension = format_of_name(name) != nullptr;
  const bool has_folder = name.find('/') != std::string::npos;
  if ((has_extension || has_folder) && is_there(name)) return name;
  const auto file_names = has_extension ? std::vector{name} : file_names_of(name);
  for (const auto& folder : folders) {
    for (const auto& file_name : file_names) {
      if (is_there(folder / file_name)) return folder / file_name;
    }
  }
  std::error_code ignored;
  if (std::filesystem::is_regular_file(name, ignored)) return name;
  throw VolumeAbsent(
      fmt::format("{}: no such {}volume in the data folders; name its folder with --data or RAYTRUTH_DATA",
                  printable(name), has_extension || has_folder ? "file here, and no such " : ""),
      hint(name, folders));
}

std::vector<NamedVolume> volumes_in(const std::vector<std::filesystem::path>& folders) {
  std::map<std::string, std::filesystem::path> found;
  for (const auto& folder : folders) {
    std::error_code ignored;
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
      const auto file_name = entry.path().filename().string();
      const auto* const format = format_of_name(file_name);
      if (format != nullptr) names.insert(file_name.substr(0, file_name.size() - format->extension.size()));
    }
    for (const auto& name : names) {
      if (found.contains(name)) continue;
      for (const auto& file_name : file_names_of(name)) {
        if (is_there(folder / file_name)) found.emplace(name, folder / file_name);
      }
    }
  }
  std::vector<NamedVolume> volumes;
  for (const auto& [name, file] : found) volumes.push_back({name, file});
  return volumes;
}

std::vector<std::filesystem::path> absent_folders(const std::vector<std::filesystem::path>& folders) {
  std::vector<std::filesystem::path> absent;
  std::error_code ignored;
  std::copy_if(folders.begin(), folders.end(), std::back_inserter(absent),
               [&ignored](const auto& folder) { return !std::filesystem::is_directory(folder, ignored); });
  return absent;
}

}  // namespace raytruth
