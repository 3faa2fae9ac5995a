#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// The program's commands. Each returns the exit code and throws InputError (2) or MissingError (3).
namespace raytruth {

struct RunOptions {
  std::vector<std::string> experiments;
  std::optional<std::string> folder;
  int threads = 0;  ///< 0: all cores
  std::string profile = "full";
  std::optional<std::int64_t> seed;
  std::optional<std::string> gl;
  bool check = false;
  bool resume = false;
  std::string data;
};
int run_experiments(const RunOptions& options);

struct EvalOptions {
  std::string file;
  int threads = 0;
  std::string data;
};
int evaluate_cases(const EvalOptions& options);

struct TableOptions {
  std::string table_case;
  std::string file;
  int threads = 0;
};
int write_table(const TableOptions& options);

struct RenderOptions {
  std::string scene;
  std::string file;  ///< of the image
  int threads = 0;
  bool is_linear = false;              ///< 8 bits are linear light, not sRGB
  std::optional<std::string> opacity;  ///< a transfer function's file, whose opacities are taken
  bool ignores_gradient_opacity = false;
  std::string data;
};
int render_scene(const RenderOptions& options);

struct CompareOptions {
  std::string reference;
  std::string image;
  std::string difference;  ///< file; empty: none
  double gain = 1;         ///< of the differences in it
};
int compare_images(const CompareOptions& options);

struct ListOptions {
  std::string kind;  ///< empty: all
  bool json = false;
};
/// What `list` can be asked for.
const std::vector<std::string>& listed_kinds();
int list_ingredients(const ListOptions& options);

struct InfoOptions {
  std::string volume;
  bool json = false;
  std::string data;
};
int show_volume(const InfoOptions& options);

struct DiffOptions {
  std::string before;
  std::string after;
  bool json = false;
  bool check = false;
};
int compare_results(const DiffOptions& options);

struct PlotOptions {
  std::vector<std::string> results;
  std::string folder = ".";
  std::string format = "svg";
};
int plot_results(const PlotOptions& options);

struct VectorsOptions {
  std::optional<std::string> file;  ///< none: standard output
  std::int64_t seed = 1;
};
int write_vectors(const VectorsOptions& options);

struct ScoreOptions {
  std::string vectors;
  std::string answers;
  bool json = false;
};
int score_answers(const ScoreOptions& options);

struct LedgerOptions {
  std::vector<std::string> results;  ///< empty: those in results/
  std::string file = "results/ledger.json";
  std::string page;  ///< empty: none
  std::string plots = "plots";
};
int keep_ledger(const LedgerOptions& options);

}  // namespace raytruth
