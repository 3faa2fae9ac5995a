#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace raytruth {

/// An experiment file that is at hand.
struct ExperimentFile {
  std::string name;
  std::string question;
  std::filesystem::path file;
};

/// The experiments of the first of these folders that exists: `experiments` in the current folder, that of the source
/// tree that the program was built in, that of the installation; sorted by name.
std::vector<ExperimentFile> find_experiments();

}  // namespace raytruth
