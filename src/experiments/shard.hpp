#pragma once

#include "experiments/runner.hpp"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace raytruth {

/// Which part of an experiment's units: the `number`-th of `count`, from 1.
struct Shard {
  std::int64_t number = 1;
  std::int64_t count = 1;
};

/// Reads "3/64". Throws InputError.
Shard read_shard(const std::string& text);
std::string to_text(const Shard& shard);

/// The units of a shard: neighbours, since those share a field. Of n units the k-th of m shards does those from
/// floor((k - 1) n / m) to floor(k n / m); with more shards than units some do none.
std::span<const Unit> units_of_shard(std::span<const Unit> units, const Shard& shard);
/// The one of `count` shards that does the i-th of n units.
Shard shard_of_unit(std::size_t i, std::size_t n, std::int64_t count);

/// What a shard leaves: the outcomes of its units, and whose they are. Its file, NAME.K-of-N.part, is JSON with SHA-256
/// digests of the experiment, of the build, and of all else.
struct Part {
  std::string file;                   ///< where it was read
  nlohmann::ordered_json experiment;  ///< as run
  nlohmann::ordered_json build;       ///< `build_of_parts`
  std::string profile;
  std::string asked;  ///< the experiment's file as it was typed
  Shard shard;
  int threads = 1;
  std::string started;
  std::vector<std::string> names;  ///< of the units
  std::vector<nlohmann::ordered_json> outcomes;
};

/// What decides about the bytes of rows besides the experiment: `build_identity`; the digest of the program where no
/// commit says what it was built from; what runs the shaders, where the experiment has some; whether programs that it
/// names may run.
nlohmann::ordered_json build_of_parts(const std::optional<GlIdentity>& gl, bool runs_programs);

/// Reads a part. Throws InputError for what is none, and where a digest is not that of what stands there.
Part read_part(const std::filesystem::path& file);

/// Does a shard's units and leaves its part in the folder, whose name is returned. What an interrupted run of the same
/// shard, experiment and build left is taken over, and a part that is there already stays, unless a volume was absent.
/// `asked` is the experiment's file as it was typed. Throws InputError, MissingError, OutputError.
std::filesystem::path run_shard(const Experiment& experiment, const std::string& asked, const Shard& shard,
                                const RunRequest& request, const std::filesystem::path& folder, RunObserver& observer);

}  // namespace raytruth
