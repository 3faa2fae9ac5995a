#include "experiments/journal.hpp"

#include "experiments/output.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cerrno>
#include <fstream>
#include <system_error>

namespace raytruth {

using Json = nlohmann::ordered_json;

namespace {

[[noreturn]] void refuse_journal(const std::filesystem::path& file) {
  throw OutputError(fmt::format("{}: cannot be written: {}; a place that can be written to is allowed", file.string(),
                                std::generic_category().message(errno)));
}

}  // namespace

Journal::Journal(const std::filesystem::path& result, const Json& run, bool resume)
    : file_(result.parent_path() / fmt::format(".{}.journal", result.stem().string())) {
  const std::string head = run.dump();
  std::string kept = head + "\n";
  if (resume) {
    std::ifstream old(file_);
    std::string line;
    if (std::getline(old, line) && line != head)
      say(fmt::format("{}: belongs to another experiment or build: starting afresh", file_.string()));
    else
      // An interrupted run may leave half a line at the end.
      while (std::getline(old, line) && !old.eof()) {
        const Json part = Json::parse(line, nullptr, false);
        if (!part.is_object() || !part.contains("name") || !part.contains("part")) break;
        parts_[part["name"]] = std::make_shared<const Json>(part["part"]);
        kept += line + "\n";
      }
  }
  write_whole(file_, kept);
  stream_.reset(std::fopen(file_.c_str(), "ab"));
  if (!stream_) refuse_journal(file_);
}

const Json* Journal::find(const std::string& name) const {
  const auto found = parts_.find(name);
  return found == parts_.end() ? nullptr : found->second.get();
}

bool Journal::is_empty() const { return parts_.empty(); }

void Journal::add(const std::string& name, const Json& part) {
  if (!stream_) return;
  const std::string line = Json{{"name", name}, {"part", part}}.dump() + "\n";
  if (std::fputs(line.c_str(), stream_.get()) < 0 || std::fflush(stream_.get()) != 0) refuse_journal(file_);
}

void Journal::remove() {
  stream_.reset();
  std::error_code ignored;
  std::filesystem::remove(file_, ignored);
}

}  // namespace raytruth
