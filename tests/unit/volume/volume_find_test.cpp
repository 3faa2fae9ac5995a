#include "raytruth/volume/files/find_volume.hpp"

#include <fmt/format.h>

#include <cstdlib>

#include "unit/volume/volume_files.hpp"

namespace raytruth::test {
namespace {

class VolumeFind : public VolumeFiles {
 protected:
  VolumeFind() {
    for (const auto* name : {"a", "b"}) std::filesystem::create_directory(folder() / name);
    folders_ = {folder() / "a", folder() / "b", folder() / "none"};
  }
  [[nodiscard]] std::filesystem::path find(const std::string& name) const { return find_volume(name, folders_); }

 private:
  std::vector<std::filesystem::path> folders_;
};

TEST_F(VolumeFind, TriesTheExtensionsInOrderAndTheFoldersInOrder) {
  const auto in_second = write("b/head.nrrd", "");
  EXPECT_EQ(find("head"), in_second);
  for (const std::string extension : {".hdr", ".nii.gz", ".nii", ".nhdr", ".nrrd"}) {
    const auto better = write("a/head" + extension, "");
    EXPECT_EQ(find("head"), better);
    EXPECT_EQ(find("head" + extension), better);
  }
}

TEST_F(VolumeFind, TakesAPathAsItStands) {
  const auto elsewhere = write("elsewhere.nrrd", "");
  EXPECT_EQ(find(elsewhere.string()), elsewhere);
  const auto unknown = write("elsewhere.raw", "");
  EXPECT_EQ(find(unknown.string()), unknown);
  std::filesystem::create_directory(folder() / "a" / "deeper");
  const auto deeper = write("a/deeper/head.nrrd", "");
  EXPECT_EQ(find("deeper/head"), deeper);
}

TEST_F(VolumeFind, AbsentVolumesAreTheirOwnException) {
  for (const std::string name : {"bonsai", "bonsai.nrrd", "none/bonsai.nii", "a", "", ".", "new\nline"}) {
    SCOPED_TRACE(name);
    try {
      (void)find(name);
      FAIL() << "found";
    } catch (const VolumeAbsent& absent) {
      const std::string message = absent.what();
      EXPECT_EQ(message.find('\n'), std::string::npos);
      EXPECT_NE(message.find("no such volume in the data folders"), std::string::npos);
      EXPECT_NE(message.find("--data or RAYTRUTH_DATA"), std::string::npos);
      EXPECT_EQ(absent.why.find(folder().string()), std::string::npos) << "results would show this machine's folders";
    }
  }
}

TEST_F(VolumeFind, HintsAtNamesThatAreAlikeAndFoldersThatAreNotThere) {
  (void)write("a/bonsai_256.nrrd", "");
  (void)write("b/neghip.nii.gz", "");
  const auto hint_of = [this](const std::string& name) {
    try {
      (void)find(name);
    } catch (const VolumeAbsent& absent) {
      return std::string(absent.what()).substr(absent.why.size());
    }
    return std::string("found");
  };
  const auto rest = fmt::format("`raytruth list volumes` names all; {} is no folder)", (folder() / "none").string());
  EXPECT_EQ(hint_of("bonsai"), " (perhaps bonsai_256; " + rest);
  EXPECT_EQ(hint_of("Bonsai.nrrd"), " (perhaps bonsai_256; " + rest);
  EXPECT_EQ(hint_of("nehgip"), " (perhaps neghip; " + rest);
  EXPECT_EQ(hint_of("something else"), " (" + rest);
}

TEST_F(VolumeFind, FilesHereAreNotAbsent) {
  // The name of the current folder's file has neither a '/' nor the extension of a volume.
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder());
  (void)write("volume.raw", "");
  (void)write("HEAD.NII", "");
  (void)write("a/volume.raw.nrrd", "");
  EXPECT_EQ(find("HEAD.NII"), "HEAD.NII");
  EXPECT_EQ(find("volume.raw"), folder() / "a/volume.raw.nrrd") << "as before";
  std::filesystem::remove(folder() / "a/volume.raw.nrrd");
  EXPECT_EQ(find("volume.raw"), "volume.raw");
  std::filesystem::current_path(before);
}

TEST_F(VolumeFind, ListsWhatItFinds) {
  for (const auto* name :
       {"a/one.nii.gz", "a/two.nhdr", "a/two.raw", "a/THREE.NRRD", "b/one.nrrd", "b/four.npy", "b/four.txt"})
    (void)write(name, "");
  const std::vector<std::filesystem::path> folders{folder() / "a", folder() / "b", folder() / "none"};
  std::vector<std::string> names;
  for (const auto& [name, file] : volumes_in(folders)) {
    names.push_back(name);
    EXPECT_EQ(find_volume(name, folders), file);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"THREE", "four", "one", "two"}));
  EXPECT_EQ(absent_folders(folders), std::vector{folder() / "none"});
}

TEST(VolumeFolders, OptionThenEnvironmentThenDebian) {
  const char* const before = std::getenv("RAYTRUTH_DATA");
  const std::string kept = before != nullptr ? before : "";
  using Folders = std::vector<std::filesystem::path>;
  ::unsetenv("RAYTRUTH_DATA");
  EXPECT_EQ(volume_folders(), (Folders{"/usr/share/mricron/templates"}));
  EXPECT_EQ(volume_folders("x::y:"), (Folders{"x", "y", "/usr/share/mricron/templates"}));
  ::setenv("RAYTRUTH_DATA", "c:d", 1);
  EXPECT_EQ(volume_folders("x"), (Folders{"x", "c", "d", "/usr/share/mricron/templates"}));
  ::setenv("RAYTRUTH_DATA", "", 1);
  EXPECT_EQ(volume_folders(), (Folders{"/usr/share/mricron/templates"}));
  if (before != nullptr) {
    ::setenv("RAYTRUTH_DATA", kept.c_str(), 1);
  } else {
    ::unsetenv("RAYTRUTH_DATA");
  }
}

}  // namespace
}  // namespace raytruth::test
