#include "raytruth/documents/outside_image.hpp"

#include "raytruth/core/npy.hpp"
#include "raytruth/documents/camera_json.hpp"
#include "raytruth/documents/read_transfer_function.hpp"
#include "raytruth/images/image_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <fstream>

namespace raytruth {

namespace {

using Json = nlohmann::ordered_json;

void write_voxels(const Grid& grid, const std::filesystem::path& file) {
  std::ofstream out(file, std::ios::binary);
  const std::string header =
      npy_header("<f8", {static_cast<std::size_t>(grid.size[2]), static_cast<std::size_t>(grid.size[1]),
                         static_cast<std::size_t>(grid.size[0])});
  out << header;
  out.write(reinterpret_cast<const char*>(grid.values.data()),
            static_cast<std::streamsize>(grid.values.size() * sizeof(double)));
  if (!out.flush()) throw OutsideRefusal("no place for the voxels that it reads");
}

}  // namespace

OutsideImage outside_image(const OutsideProgram& program, const Scene& scene, Json drawing) {
  const TemporaryFolder folder;
  const std::filesystem::path voxels = folder.path() / "volume.npy";
  write_voxels(scene.grid, voxels);
  for (const char* const of_file : {"repair", "nan", "time_step"}) drawing.erase(of_file);
  drawing["raytruth"] = "scene/1";
  drawing["volume"] = voxels.string();
  drawing["spacing"] = scene.grid.spacing;
  drawing["border"] = name_of(scene.border);
  drawing["transfer_function"] = transfer_function_json(scene.transfer, scene.isosurfaces);
  drawing["emission"] = scene.emission == Emission::plain ? "plain" : "associated";
  drawing["camera"] = camera_json(scene.camera);
  drawing["scheme"] = "reference";
  OutsideAnswer answer = ask(program, drawing.dump());
  try {
    StoredImage stored = image_of_npy("its answer", answer.bytes);
    if (!stored.has_opacity || stored.image.size != scene.camera.size)
      throw InputError(fmt::format("its answer: found {} x {} pixels{}; {} x {} with 4 channels are allowed",
                                   stored.image.size[0], stored.image.size[1],
                                   stored.has_opacity ? "" : " without opacity", scene.camera.size[0],
                                   scene.camera.size[1]));
    return {std::move(stored.image), std::move(answer.version)};
  } catch (const InputError& error) {
    throw OutsideRefusal(error.what());
  }
}

}  // namespace raytruth
