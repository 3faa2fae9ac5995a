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

/// The file that is meant: `asked` itself where there is such a file, else the experiment of that name among
/// `find_experiments()`. Throws InputError, which says where was looked.
std::string find_experiment(const std::string& asked);

}  // namespace raytruth
