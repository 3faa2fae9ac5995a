#include "raytruth/volume/files/find_volume.hpp"

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
      EXPECT_EQ(message.find(folder().string()), std::string::npos) << "results would show this machine's folders";
    }
  }
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
